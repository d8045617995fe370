// SPDX-License-Identifier: Apache-2.0
// Bits of a unit of an H.264 stream.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace viewloom {

// Bits of a unit without its emulation prevention bytes (7.3.1). Past the end all bits are 0, and
// isWhole() says so.
class UnitBits {
 public:
  explicit UnitBits(std::span<const uint8_t> unit) {
    for (size_t i = 0; i < unit.size(); ++i) {
      const bool prevents = i >= 2 && unit[i] == 3 && unit[i - 1] == 0 && unit[i - 2] == 0;
      if (!prevents) bytes_.push_back(unit[i]);
    }
  }

  uint32_t bits(uint32_t count) {
    uint32_t value = 0;
    for (uint32_t i = 0; i < count; ++i, ++at_) {
      const size_t byte = at_ / 8;
      const uint32_t bit = byte < bytes_.size() ? bytes_[byte] >> (7 - at_ % 8) & 1 : 0;
      value = value << 1 | bit;
    }
    return value;
  }
  bool flag() { return bits(1) != 0; }
  // ue(v) of 9.1. More than 31 zeros are no number.
  uint32_t number() {
    uint32_t zeros = 0;
    while (!flag()) {
      if (++zeros < 32 && isWhole()) continue;
      is_broken_ = true;
      return 0;
    }
    return (uint32_t{1} << zeros) - 1 + bits(zeros);
  }
  bool isWhole() const { return !is_broken_ && at_ <= 8 * bytes_.size(); }

 private:
  std::vector<uint8_t> bytes_;
  size_t at_ = 0;
  bool is_broken_ = false;
};

}  // namespace viewloom
