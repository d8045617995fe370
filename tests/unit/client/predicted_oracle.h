// SPDX-License-Identifier: Apache-2.0
// Reads predicted planes by the letter of proto PLANE_COMPRESSION_PREDICTED_ZSTD.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace viewloom::test {

// `bytes` are what the plane's zstd frame holds. Returns [height][width].
inline std::vector<uint16_t> unpredict(const std::vector<uint8_t>& bytes, uint32_t width,
                                       uint32_t height) {
  const size_t area = size_t{width} * height;
  std::vector<uint16_t> s(area);
  const auto at = [&](long x, long y) {
    return x < 0 || y < 0 ? 0L : long{s[static_cast<size_t>(y) * width + static_cast<size_t>(x)]};
  };
  for (size_t i = 0; i < area; ++i) {
    const long x = static_cast<long>(i % width);
    const long y = static_cast<long>(i / width);
    const long z = bytes.at(i) + 256L * bytes.at(area + i);
    const long d = z % 2 == 0 ? z / 2 : (131071 - z) / 2;
    const long sample = d + at(x - 1, y) + at(x, y - 1) - at(x - 1, y - 1);
    s[i] = static_cast<uint16_t>(((sample % 65536) + 65536) % 65536);
  }
  return s;
}

}  // namespace viewloom::test
