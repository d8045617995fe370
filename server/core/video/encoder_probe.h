// SPDX-License-Identifier: Apache-2.0
// Tries a video encoder on this machine: encodes a few pictures, decodes them, and compares.
#pragma once

#include <string>

#include "base/status.h"
#include "video/encoder_kind.h"

namespace viewloom {

struct EncoderProbe {
  std::string name;  // as in VideoEncoderKind
  std::string library;
  absl::Status status;    // OK = the encoder serves; else why not
  double psnr_db = 0;     // the least of the planes and pictures
  double picture_ms = 0;  // time of encoding, the mean of all pictures
};

// Pictures of a probe.
inline constexpr SizePx kProbePicture_px = {640, 360};

// Encodes two atlases of four pictures with one encoder. Each picture must come at once and
// alone, in the form of OpenH264Encoder, and OpenH264Decoder must find it like what went in. Takes
// some ten milliseconds, and where a device has to be opened, up to a second.
EncoderProbe probeVideoEncoder(const VideoEncoderKind& kind);

}  // namespace viewloom
