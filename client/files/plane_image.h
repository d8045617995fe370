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
  bool has_alpha = false;
  uint32_t code_max = 0;  // DEPTH_U16: the largest that the file's bits can hold
  std::optional<Imf::Chromaticities> chromaticities;  // colour whose file states them
  std::vector<uint8_t> bytes;                         // packed, top row first
};

// Refuses what no plane may be, before memory is spent on it.
absl::Status checkPlaneSize(const std::string& file, int64_t width_px, int64_t height_px);

}  // namespace viewloom::files
