// SPDX-License-Identifier: Apache-2.0
// Encodings that each kind of plane accepts, and sizes of their samples.
#pragma once

#include <cstdint>

#include "frame/frame.h"

namespace viewloom {

bool isEncodingOf(PlaneKind kind, PlaneEncoding encoding);
// All encodings of a kind, named as in proto: "R8, RGB8".
const char* encodingsOf(PlaneKind kind);
// Whether a plane is a picture that a codec has made of any number of bytes: JPEG, H264.
bool isCodedPicture(PlaneEncoding encoding);
// Most bytes of such a plane, whatever it shows.
uint64_t codedBytesMax(const PlaneFormat& plane);
// Whether a Frame holds the plane as RGBA8.
bool becomesRgba8(PlaneEncoding encoding);
// Memory that the decoder of such a plane takes, beside its bytes and the decoded plane.
uint64_t codecBytes(const PlaneFormat& plane);
// Bytes of one pixel as sent; 0 for coded pictures.
uint32_t wirePixelBytes(PlaneEncoding encoding);
// Bytes of the plane between zstd and the next decoder: its uncompressed bytes, or for JPEG the
// most that is accepted. 0 without zstd.
uint64_t inflatedBytesMax(const PlaneFormat& plane);
// Whether the uncompressed bytes of the plane are held by a Frame without a change.
bool isHeldAsSent(const PlaneFormat& plane);
// Whether the plane becomes RGBA8 while its bytes come: RGB8 with nothing between its pixels.
bool widensOnArrival(const PlaneFormat& plane);

}  // namespace viewloom
