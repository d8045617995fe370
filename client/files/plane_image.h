// SPDX-License-Identifier: Apache-2.0
// One plane as a file gave it, in an encoding of the wire.
#pragma once

#include <OpenEXR/ImfChromaticities.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/status.h"
#include "viewloom/v1/frame.pb.h"

namespace viewloom::files {

inline constexpr int64_t kSideMax_px = 8192;  // of a plane, as the server accepts

struct PlaneImage {
  uint32_t width_px = 0;
  uint32_t height_px = 0;
  v1::PlaneEncoding encoding = v1::PLANE_ENCODING_UNSPECIFIED;
  v1::ColorTransfer transfer = v1::COLOR_TRANSFER_UNSPECIFIED;  // of 8 bits, where it is not sRGB
  bool has_alpha = false;
  bool is_premultiplied = false;  // by the file, where there is alpha
  uint32_t code_max = 0;          // whole numbers: the code of white, else 0; packed depth: 1
  std::optional<Imf::Chromaticities> chromaticities;  // colour whose file states them
  std::vector<uint8_t> bytes;                         // packed, top row first
};

// Refuses what no plane may be, before memory is spent on it.
absl::Status checkPlaneSize(const std::string& file, int64_t width_px, int64_t height_px);

}  // namespace viewloom::files
