// SPDX-License-Identifier: Apache-2.0
// Pictures of whole numbers, as PNG and JPEG hold them, and planes made of them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/status.h"
#include "files/plane_image.h"
#include "viewloom/v1/manifest.pb.h"

namespace viewloom::files {

// bytes: [height_px][width_px][channels], packed, top row first; 16 bits little endian.
struct Picture {
  uint32_t width_px = 0;
  uint32_t height_px = 0;
  uint32_t channels = 0;  // 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA
  uint32_t bits = 8;      // 8 or 16
  std::vector<uint8_t> bytes;
};

// `file` is for messages: a picture without two such halves is refused.
absl::StatusOr<Picture> cutPart(const std::string& file, Picture picture, v1::ImagePart part);

// Three or four channels. RGB8 or RGBA8 as stored; 16 bits come as RGBA16F: sRGB decoded to linear
// light, or, when linear_samples, just divided by 65535.
PlaneImage colorPlane(Picture picture, bool linear_samples);

// DEPTH_U16: 16 bits as stored; 8 bits as 0..255, or, when spread, 0..65535. RGB counts as grey
// where its channels agree, but for what a JPEG adds; coloured pictures are refused.
absl::StatusOr<PlaneImage> depthPlane(const std::string& file, const Picture& picture, bool spread);

}  // namespace viewloom::files
