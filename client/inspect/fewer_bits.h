// SPDX-License-Identifier: Apache-2.0
// Codes of fewer bits in a file that has room for 16.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

namespace viewloom::inspect {

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
