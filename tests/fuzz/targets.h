// SPDX-License-Identifier: Apache-2.0
// The functions of fuzz_target.h. The comment of each says how it reads its bytes.
#pragma once

#include <cstdint>
#include <span>

namespace viewloom {

using FuzzBytes = std::span<const uint8_t>;

// The decoders of the server.
// The expected width and height, a byte each; a JPEG.
bool fuzzJpeg(FuzzBytes bytes);
// The expected size less one, in two bytes; a zstd frame.
bool fuzzZstd(FuzzBytes bytes);
// Width and height, each less one; a predicted depth plane.
bool fuzzPredicted(FuzzBytes bytes);
// Width and height, each less 16; colour in H.264.
bool fuzzVideoPlane(FuzzBytes bytes);
// A script: a header, then chunks. Accepted frames are decoded, alone and by the intake's threads.
bool fuzzFrame(FuzzBytes bytes);

// Messages over gRPC.
bool fuzzHeader(FuzzBytes bytes);    // FrameHeader
bool fuzzDisplay(FuzzBytes bytes);   // OpenDisplay
bool fuzzEyePoses(FuzzBytes bytes);  // EyePoses
// How the message is cut, in a byte; a PublishFramesRequest, read with and without protobuf.
bool fuzzChunk(FuzzBytes bytes);
// A script of several calls that publish and watch: what each client sends, and when.
bool fuzzCalls(FuzzBytes bytes);

// Texts over HTTP and WebSockets.
bool fuzzDisplayJson(FuzzBytes bytes);  // Display
bool fuzzCalibration(FuzzBytes bytes);  // calibration of a panel
bool fuzzViewer(FuzzBytes bytes);       // messages of /ws, one a line
bool fuzzHttp(FuzzBytes bytes);         // lines: target, Host, Origin

// Identities, and the files that decide about access.
bool fuzzTokens(FuzzBytes bytes);  // the token file
// Lines: header and claims, which are signed here; a token that nobody signed.
bool fuzzJwt(FuzzBytes bytes);
bool fuzzKeySet(FuzzBytes bytes);       // JWKS
bool fuzzLink(FuzzBytes bytes);         // signature of a link
bool fuzzCertificate(FuzzBytes bytes);  // PEM with certificates and a key

// Files of operators and users.
bool fuzzSettings(FuzzBytes bytes);    // viewloomd.toml
bool fuzzRecording(FuzzBytes bytes);   // of frames or atlases
bool fuzzPicture(FuzzBytes bytes);     // pictures that no library reads
bool fuzzMetadata(FuzzBytes bytes);    // Exif, ICC, XMP and the segments of a JPEG
bool fuzzExr(FuzzBytes bytes);         // deep EXR
bool fuzzManifest(FuzzBytes bytes);    // manifest of a frame
bool fuzzCameraList(FuzzBytes bytes);  // cameras of TMIV
bool fuzzEyeLine(FuzzBytes bytes);     // a line of an eye tracker

// Messages of a server, as clients read them: the length of each in two bytes, then a
// StreamAtlasesResponse.
bool fuzzAtlas(FuzzBytes bytes);
// Half the width and half the height, each less one; then the length of each picture in two bytes,
// and an access unit of H.264.
bool fuzzVideo(FuzzBytes bytes);

}  // namespace viewloom
