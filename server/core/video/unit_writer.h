// SPDX-License-Identifier: Apache-2.0
// Writes a unit of an H.264 stream bit by bit.
#pragma once

#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

namespace viewloom {

// The counterpart of UnitBits. Thread-safety: none.
class UnitWriter {
 public:
  void bits(uint32_t value, uint32_t count) {
    for (uint32_t i = count; i-- > 0;) {
      byte_ = uint8_t(uint32_t{byte_} << 1U | (value >> i & 1U));
      if (++filled_ == 8) put(std::exchange(byte_, 0));
    }
  }
  void flag(bool value) { bits(value ? 1 : 0, 1); }
  // ue(v) of 9.1. Expects less than 2^32 - 1.
  void number(uint32_t value) {
    const auto width = uint32_t(std::bit_width(value + 1));
    bits(0, width - 1);
    bits(value + 1, width);
  }
  // The unit with its last bits (7.3.2.11), and with emulation prevention bytes (7.3.1).
  std::vector<uint8_t> finish() {
    flag(true);
    while (filled_ != 0) flag(false);
    return std::move(bytes_);
  }

 private:
  void put(uint8_t byte) {
    filled_ = 0;
    const bool needs_prevention = zero_count_ >= 2 && byte <= 3;
    if (needs_prevention) bytes_.push_back(3);
    if (needs_prevention) zero_count_ = 0;
    zero_count_ = byte == 0 ? zero_count_ + 1 : 0;
    bytes_.push_back(byte);
  }

  std::vector<uint8_t> bytes_;
  uint8_t byte_ = 0;  // not yet whole
  uint32_t filled_ = 0;
  uint32_t zero_count_ = 0;  // zeros at the end of bytes_
};

}  // namespace viewloom
