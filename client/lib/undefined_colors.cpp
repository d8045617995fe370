// SPDX-License-Identifier: Apache-2.0
#include "lib/undefined_colors.h"

#include <algorithm>
#include <array>

#include "base/check.h"
#include "lib/inverse_depth.h"

namespace viewloom {
namespace {

constexpr uint32_t kBlock_px = 16;  // macroblock of H.264
constexpr size_t kChannels = 3;

using Rgb = std::array<uint8_t, kChannels>;

struct Block {
  uint32_t x = 0;
  uint32_t y = 0;
  uint32_t x_end = 0;
  uint32_t y_end = 0;
};

// Calls `act` with the index of each pixel of the block.
template <typename Act>
void forEachPixel(const Block& block, SizePx size_px, const Act& act) {
  for (uint32_t y = block.y; y < block.y_end; ++y) {
    for (uint32_t x = block.x; x < block.x_end; ++x) act(size_t{y} * size_px.width + x);
  }
}

}  // namespace

void fillUndefinedColors(std::span<const float> inv_z, SizePx size_px, size_t pixel_bytes,
                         std::span<uint8_t> colors) {
  VIEWLOOM_CHECK(inv_z.size() == size_px.area());
  VIEWLOOM_CHECK(colors.size() == pixel_bytes * size_px.area() && pixel_bytes >= kChannels);
  Rgb mean{};
  for (uint32_t y = 0; y < size_px.height; y += kBlock_px) {
    for (uint32_t x = 0; x < size_px.width; x += kBlock_px) {
      const Block block = {x, y, std::min(x + kBlock_px, size_px.width),
                           std::min(y + kBlock_px, size_px.height)};
      std::array<uint32_t, kChannels> sums{};
      uint32_t count = 0;
      forEachPixel(block, size_px, [&](size_t pixel) {
        if (inv_z[pixel] == kNoInvZ) return;
        ++count;
        for (size_t c = 0; c < kChannels; ++c) sums[c] += colors[pixel_bytes * pixel + c];
      });
      for (size_t c = 0; c < kChannels && count > 0; ++c) mean[c] = uint8_t(sums[c] / count);
      forEachPixel(block, size_px, [&](size_t pixel) {
        if (inv_z[pixel] == kNoInvZ) std::ranges::copy(mean, &colors[pixel_bytes * pixel]);
      });
    }
  }
}

}  // namespace viewloom
