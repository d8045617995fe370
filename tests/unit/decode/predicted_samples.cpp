// SPDX-License-Identifier: Apache-2.0
#include "unit/decode/predicted_samples.h"

#include <cstddef>

namespace viewloom {

std::vector<uint8_t> predictedBytes(const std::vector<uint16_t>& samples, int width, int height) {
  const auto s = [&](int x, int y) {
    return x < 0 || y < 0 ? 0 : int{samples.at(static_cast<size_t>(y * width + x))};
  };
  std::vector<uint8_t> low;
  std::vector<uint8_t> high;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int difference = s(x, y) - (s(x - 1, y) + s(x, y - 1) - s(x - 1, y - 1));
      const int d = ((difference % 65536) + 65536) % 65536;
      const int z = d < 32768 ? 2 * d : 131071 - 2 * d;
      low.push_back(static_cast<uint8_t>(z % 256));
      high.push_back(static_cast<uint8_t>(z / 256));
    }
  }
  low.insert(low.end(), high.begin(), high.end());
  return low;
}

std::vector<uint8_t> littleEndian(const std::vector<uint16_t>& samples) {
  std::vector<uint8_t> bytes;
  for (const uint16_t sample : samples) {
    bytes.push_back(static_cast<uint8_t>(sample % 256));
    bytes.push_back(static_cast<uint8_t>(sample / 256));
  }
  return bytes;
}

}  // namespace viewloom
