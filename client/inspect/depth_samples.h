// SPDX-License-Identifier: Apache-2.0
// The depth of a layer as 1/Z, and what its samples were.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/status.h"
#include "viewloom/v1/frame.pb.h"

namespace viewloom::inspect {

inline constexpr float kNoSurface = -1;
// From here on, numbers are those that renderers write where they hit nothing.
inline constexpr float kHuge = 1e9F;

// Finite numbers of kHuge and more.
struct HugeNumbers {
  uint64_t count = 0;
  float most_frequent = 0;
  uint64_t most_frequent_count = 0;
};

struct DepthSamples {
  uint32_t width_px = 0;
  uint32_t height_px = 0;
  // float[height_px][width_px], top row first: 1/Z in 1/m, 0 infinitely far, kNoSurface without.
  std::vector<float> inv_z;

  uint64_t surface_count = 0;  // nearer than infinity
  uint64_t sky_count = 0;      // infinitely far
  uint64_t invalid_count = 0;  // of the invalid value, or metric 0: no surface
  uint64_t bad_count = 0;      // NaN, negative or nearer than 1 nm: no surface
  // Bad samples by the number that is stored.
  uint64_t bad_nan_count = 0;
  uint64_t bad_minus_infinity_count = 0;
  uint64_t bad_negative_count = 0;  // finite

  // Range of the numbers as stored, where there is a surface nearer than infinity; U16 as 0..65535.
  float stored_min = 0;
  float stored_max = 0;
  uint64_t at_min_count = 0;
  uint64_t at_max_count = 0;
  // The largest finite number of all.
  float largest_stored = 0;
  // Whether all numbers are multiples of 257, as of 8 bits that were stretched to 16.
  bool is_stretched = false;
  HugeNumbers huge;
  bool has_scattered_zeros = false;  // ZeroPattern::isScattered
  bool has_points_alone = false;     // ZeroPattern::isOfPoints

  uint64_t sampleCount() const { return uint64_t{width_px} * height_px; }
  // From one sample to the next of a grid of at most 256 cells a side.
  uint32_t gridStride_px() const {
    constexpr uint32_t kCellsMax = 256;
    return std::max(1U, (std::max(width_px, height_px) + kCellsMax - 1) / kCellsMax);
  }
};

// `plane`: of depth, with its bytes packed. Faces of cube maps are read as PLANAR. Errors name the
// field of the plane's format.
absl::StatusOr<DepthSamples> readDepthSamples(const v1::Plane& plane,
                                              const std::vector<uint8_t>& bytes,
                                              const v1::Camera& camera);

}  // namespace viewloom::inspect
