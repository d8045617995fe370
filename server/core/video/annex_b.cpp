// SPDX-License-Identifier: Apache-2.0
#include "video/annex_b.h"

#include <algorithm>
#include <array>

namespace viewloom {
namespace {

constexpr std::array<uint8_t, 3> kStartCode = {0, 0, 1};

// Zeros before a start code belong to it, and those at the end to nothing (B.1).
std::span<const uint8_t> withoutTrailingZeros(std::span<const uint8_t> unit) {
  while (!unit.empty() && unit.back() == 0) unit = unit.first(unit.size() - 1);
  return unit;
}

}  // namespace

std::vector<NalUnit> nalUnits(std::span<const uint8_t> stream) {
  std::vector<NalUnit> units;
  auto code = std::search(stream.begin(), stream.end(), kStartCode.begin(), kStartCode.end());
  while (code != stream.end()) {
    const auto begin = code + kStartCode.size();
    code = std::search(begin, stream.end(), kStartCode.begin(), kStartCode.end());
    const std::span<const uint8_t> unit = withoutTrailingZeros({begin, code});
    if (!unit.empty()) units.push_back({unit});
  }
  return units;
}

}  // namespace viewloom
