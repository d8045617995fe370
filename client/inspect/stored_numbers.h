// SPDX-License-Identifier: Apache-2.0
// Depth samples as a plane stores them, before anybody says what they mean.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "viewloom/v1/frame.pb.h"

namespace viewloom::inspect {

// `plane`: of depth, with its bytes packed; top row first, U16 as 0..65535.
std::vector<float> storedNumbers(const v1::Plane& plane, const std::vector<uint8_t>& bytes);

// Where a depth image has 0: in areas, as a sky, or scattered, as measurements that failed.
struct ZeroPattern {
  uint64_t zero_count = 0;
  uint64_t clear_count = 0;     // numbers that are clearly not 0
  uint64_t lone_count = 0;      // ... of these, between two zeros along x or y
  uint64_t enclosed_count = 0;  // zeros with clear numbers on all four sides
  uint64_t hole_count = 0;      // groups of these

  // Most numbers are points between zeros, as of a scanner.
  bool isOfPoints() const;
  // So they are, or most zeros lie in many small holes of surfaces, as where two cameras found no
  // match.
  bool isScattered() const;
};
ZeroPattern zeroPattern(std::span<const float> stored, uint32_t width_px, uint32_t height_px);

}  // namespace viewloom::inspect
