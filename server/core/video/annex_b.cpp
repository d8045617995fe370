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

// The bytes from the first start code on.
std::span<const uint8_t> fromStartCode(std::span<const uint8_t> bytes) {
  return {std::search(bytes.begin(), bytes.end(), kStartCode.begin(), kStartCode.end()),
          bytes.end()};
}

}  // namespace

NalReader::NalReader(std::span<const uint8_t> stream) : rest_(fromStartCode(stream)) {}

std::optional<NalUnit> NalReader::next() {
  while (!rest_.empty()) {
    const std::span<const uint8_t> begun = rest_.subspan(kStartCode.size());
    rest_ = fromStartCode(begun);
    const std::span<const uint8_t> unit =
        withoutTrailingZeros(begun.first(begun.size() - rest_.size()));
    if (!unit.empty()) return NalUnit{unit};
  }
  return std::nullopt;
}

std::vector<NalUnit> nalUnits(std::span<const uint8_t> stream) {
  std::vector<NalUnit> units;
  NalReader reader(stream);
  while (const std::optional<NalUnit> unit = reader.next()) units.push_back(*unit);
  return units;
}

}  // namespace viewloom
