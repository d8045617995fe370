// SPDX-License-Identifier: Apache-2.0
// Fuzzed bytes as decisions: each target takes what it needs, one after the other.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace viewloom {

// Hands out the bytes of a script; zeros when it is at its end. Thread-safety: none.
class Script {
 public:
  explicit Script(std::span<const uint8_t> bytes) : rest_(bytes) {}

  bool atEnd() const { return rest_.empty(); }

  // A number of `count` bytes, the highest first.
  uint32_t take(size_t count = 1) {
    uint32_t value = 0;
    for (const uint8_t byte : takeBytes(count)) value = value << 8 | byte;
    return value;
  }

  // Fewer at the end.
  std::span<const uint8_t> takeBytes(size_t count) {
    const std::span<const uint8_t> taken = rest_.first(std::min(count, rest_.size()));
    rest_ = rest_.subspan(taken.size());
    return taken;
  }

  std::span<const uint8_t> takeRest() { return takeBytes(rest_.size()); }

 private:
  std::span<const uint8_t> rest_;
};

inline std::string_view asText(std::span<const uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace viewloom
