// SPDX-License-Identifier: Apache-2.0
// Depth samples as a plane stores them, before anybody says what they mean.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
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

inline constexpr uint32_t kU16Max = 65535;

struct FewerBits {
  uint32_t last_code;
  const char* what;
};

// The bits whose last code is the largest number of a plane. Photoshop's filters overshoot by a few
// codes.
inline std::optional<FewerBits> fewerBits(double largest) {
  constexpr FewerBits kPhotoshop{32768, "Photoshop's 15 bits"};
  if (std::abs(largest - kPhotoshop.last_code) <= 0.002 * kPhotoshop.last_code) return kPhotoshop;
  constexpr std::array<FewerBits, 3> kFewerBits{
      {{1023, "10 bits"}, {4095, "12 bits"}, {16383, "14 bits"}}};
  for (const FewerBits& fewer : kFewerBits) {
    if (largest == fewer.last_code) return fewer;
  }
  return std::nullopt;
}

}  // namespace viewloom::inspect
