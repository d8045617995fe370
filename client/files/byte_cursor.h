// SPDX-License-Identifier: Apache-2.0
// Takes little-endian numbers and texts from bytes of unknown quality, never beyond their end.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>

namespace viewloom::files {

// Reads beyond the end give 0 or empty, and hasFailed() is true from then on: a caller asks once,
// before it believes anything.
class ByteCursor {
 public:
  explicit ByteCursor(std::span<const uint8_t> bytes, size_t offset = 0)
      : bytes_(bytes), offset_(std::min(offset, bytes.size())), has_failed_(offset_ != offset) {}

  bool hasFailed() const { return has_failed_; }
  size_t offset() const { return offset_; }
  size_t leftCount() const { return bytes_.size() - offset_; }

  std::span<const uint8_t> take(uint64_t count) {
    if (count > leftCount()) {
      has_failed_ = true;
      offset_ = bytes_.size();
      return {};
    }
    const auto taken = bytes_.subspan(offset_, count);
    offset_ += count;
    return taken;
  }

  uint64_t take64() { return takeNumber(8); }
  uint32_t take32() { return static_cast<uint32_t>(takeNumber(4)); }
  int32_t takeSigned32() { return static_cast<int32_t>(take32()); }
  uint8_t take8() { return static_cast<uint8_t>(takeNumber(1)); }

  // Up to the next 0 byte, which is taken as well. Fails if there is none.
  std::string takeText() {
    const auto rest = bytes_.subspan(offset_);
    const auto end = std::find(rest.begin(), rest.end(), uint8_t{0});
    const std::string text(rest.begin(), end);
    take(text.size() + 1);
    return has_failed_ ? std::string() : text;
  }

 private:
  uint64_t takeNumber(size_t byte_count) {
    uint64_t number = 0;
    const auto taken = take(byte_count);
    for (size_t i = 0; i < taken.size(); ++i) number |= uint64_t{taken[i]} << (8 * i);
    return number;
  }

  std::span<const uint8_t> bytes_;
  size_t offset_;
  bool has_failed_;
};

}  // namespace viewloom::files
