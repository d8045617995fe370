// SPDX-License-Identifier: Apache-2.0
// Pictures as their files hold them, whatever the container, and planes made of them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/status.h"
#include "files/color_coding.h"
#include "files/plane_image.h"
#include "viewloom/v1/manifest.pb.h"

namespace viewloom::files {

// bytes: [height_px][width_px][channels], packed, top row first, little endian.
struct Picture {
  uint32_t width_px = 0;
  uint32_t height_px = 0;
  uint32_t channels = 0;  // 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA
  uint32_t bits = 8;      // 8 or 16: whole numbers; 32: binary32
  uint32_t code_max = 0;  // whole numbers: the code that stands for white; 0 = all bits set
  ColorCoding coding;
  std::vector<uint8_t> bytes;

  size_t pixelCount() const { return size_t{width_px} * height_px; }
  size_t pixelBytes() const { return size_t{channels} * (bits / 8); }
  uint32_t whiteCode() const { return code_max != 0 ? code_max : bits == 8 ? 255 : 65535; }
  // The number as stored.
  float sampleAt(size_t index) const;
};

// Purpose of a picture. Decoders keep samples of depth unchanged.
enum class PictureUse { kColor, kDepth };

// `file` is for messages: a picture without two such halves is refused.
absl::StatusOr<Picture> cutPart(const std::string& file, Picture picture, v1::ImagePart part);

// Turned and mirrored as Exif's orientation says, 1..8.
Picture turned(Picture picture, uint32_t orientation);

// Rows in the opposite order.
void flipRows(std::vector<uint8_t>& bytes, size_t height_px);

// RGB8 or RGBA8 of 8 bits, sRGB or (transfer LINEAR) linear; RGBA16F in linear light of 16 bits and
// floats, and of primaries that the wire does not know. `transfer` overrides the file. Grey becomes
// colour. Infinite samples become the largest finite ones, NaN becomes 0.
PlaneImage colorPlane(Picture picture, v1::ColorTransfer transfer);

// DEPTH_U16: 16 bits as stored; 8 bits as 0..255, or, when spread (of window depth), 0..65535.
// DEPTH_F32: floats as stored; when spread, codes of a smaller white as 0..1. RGB counts as grey
// where its channels agree, but for what a JPEG adds; coloured pictures are refused.
absl::StatusOr<PlaneImage> depthPlane(const std::string& file, const Picture& picture, bool spread);

}  // namespace viewloom::files
