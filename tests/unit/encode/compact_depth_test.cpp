// SPDX-License-Identifier: Apache-2.0
// Compact depth, unpacked by zlib and by the words of its header.
#include "encode/compact_depth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace viewloom::compact_depth_test {
namespace {

struct Depth {
  uint32_t width_px = 0;
  uint32_t height_px = 0;
  std::vector<float> inv_z;

  float at(uint32_t x, uint32_t y) const { return inv_z[size_t{y} * width_px + x]; }
};

template <typename Function>
Depth depthOf(uint32_t width_px, uint32_t height_px, const Function& inv_z) {
  Depth depth{width_px, height_px, {}};
  for (uint32_t y = 0; y < height_px; ++y) {
    for (uint32_t x = 0; x < width_px; ++x) depth.inv_z.push_back(float(inv_z(x, y)));
  }
  return depth;
}

// The nearest surface of each block of 2 x 2 px.
Depth blocksOf(const Depth& depth) {
  return depthOf((depth.width_px + 1) / 2, (depth.height_px + 1) / 2, [&](uint32_t x, uint32_t y) {
    float nearest = 0;
    for (uint32_t row = 2 * y; row < std::min(2 * y + 2, depth.height_px); ++row) {
      for (uint32_t column = 2 * x; column < std::min(2 * x + 2, depth.width_px); ++column) {
        const float inv_z = depth.at(column, row);
        if (std::isfinite(inv_z)) nearest = std::max(nearest, inv_z);
      }
    }
    return nearest;
  });
}

SharedBytes pack(CompactDepthEncoder& encoder, const Depth& depth, size_t gap_bytes = 0) {
  const size_t row_bytes = depth.width_px * sizeof(float);
  const size_t stride_bytes = row_bytes + gap_bytes;
  std::vector<uint8_t> padded(stride_bytes * depth.height_px, 0xa5);
  for (uint32_t y = 0; y < depth.height_px; ++y) {
    std::memcpy(&padded[y * stride_bytes], &depth.inv_z[size_t{y} * depth.width_px], row_bytes);
  }
  return encoder.encode({.plane = AtlasPlane::kDepth,
                         .row_count = depth.height_px,
                         .width_px = depth.width_px,
                         .bytes = padded,
                         .stride_bytes = stride_bytes});
}

Depth unpack(const std::vector<uint8_t>& bytes, uint32_t columns, uint32_t rows) {
  float step = 0;
  std::memcpy(&step, bytes.data(), sizeof(step));
  std::vector<uint8_t> residuals(2 * size_t{columns} * rows);
  uLongf length = uLongf(residuals.size());
  EXPECT_EQ(uncompress(residuals.data(), &length, bytes.data() + 4, uLong(bytes.size() - 4)), Z_OK);
  EXPECT_EQ(length, residuals.size());
  std::vector<uint16_t> codes(size_t{columns} * rows);
  return depthOf(columns, rows, [&](uint32_t x, uint32_t y) {
    const size_t at = size_t{y} * columns + x;
    const uint32_t written = residuals[at] | residuals[codes.size() + at] << 8;
    const uint32_t residual = (written >> 1) ^ (written & 1 ? 0xffff : 0);
    const uint32_t left = x > 0 ? codes[at - 1] : 0;
    const uint32_t above = y > 0 ? codes[at - columns] : 0;
    const uint32_t above_left = x > 0 && y > 0 ? codes[at - columns - 1] : 0;
    codes[at] = uint16_t(residual + left + above - above_left);
    return float(codes[at]) * step;
  });
}

void expectNear(const Depth& depth, const SharedBytes& packed) {
  const Depth expected = blocksOf(depth);
  const Depth unpacked = unpack(*packed, expected.width_px, expected.height_px);
  const float nearest = *std::ranges::max_element(expected.inv_z);
  const float error = 0.501F * nearest / float(kCompactDepthCodeMax);
  for (size_t i = 0; i < expected.inv_z.size(); ++i) {
    ASSERT_NEAR(unpacked.inv_z[i], expected.inv_z[i], error) << "block " << i;
  }
}

TEST(CompactDepth, keepsTheNearestSurfaceOfEachBlock) {
  BytePool pool(4);
  CompactDepthEncoder encoder(pool);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> inv_z(0, 30);
  for (const auto& [width_px, height_px] :
       {std::pair{64U, 32U}, {63U, 31U}, {1U, 1U}, {2U, 5U}, {7U, 1U}}) {
    const Depth depth = depthOf(width_px, height_px, [&](auto...) { return inv_z(random); });
    expectNear(depth, pack(encoder, depth, 12));
  }
}

TEST(CompactDepth, packsPlanesIntoLittleAndEdgesExactly) {
  BytePool pool(4);
  CompactDepthEncoder encoder(pool);
  const Depth depth = depthOf(1280, 128, [](uint32_t x, uint32_t y) {
    return x > 300 && x < 500 && y > 40 ? 0.9 : 0.1 + 1e-4 * x + 2e-4 * y;
  });
  const SharedBytes packed = pack(encoder, depth);
  expectNear(depth, packed);
  EXPECT_LT(packed->size(), 640U * 64 * 2 / 8) << "two bits a sample";
}

// Balls of all sizes before a bumpy ground and a far wall.
double someScene(uint32_t x, uint32_t y) {
  const double u = x / 1280.0;
  const double v = y / 720.0;
  const double bumps = 0.002 * std::sin(90 * u) * std::sin(70 * v * v);
  double inv_z = std::max(0.05, 0.6 * (v - 0.35) + bumps);
  for (int ball = 0; ball < 24; ++ball) {
    const double radius = 0.02 + 0.004 * ball;
    const double du = u - std::fmod(0.37 * ball, 1);
    const double dv = (v - std::fmod(0.61 * ball, 1)) * 720 / 1280;
    const double rest = radius * radius - du * du - dv * dv;
    if (rest > 0) inv_z = std::max(inv_z, 0.1 + 0.03 * ball + 0.5 * std::sqrt(rest));
  }
  return inv_z;
}

TEST(CompactDepth, takesLessThanTenMegabitsASecondFor720Lines) {
  constexpr double kRate_hz = 20;
  constexpr uint32_t kBandRows = 128;
  BytePool pool(4);
  CompactDepthEncoder encoder(pool);
  size_t bytes = 0;
  for (uint32_t first = 0; first < 720; first += kBandRows) {
    const Depth band = depthOf(1280, std::min(kBandRows, 720 - first),
                               [&](uint32_t x, uint32_t y) { return someScene(x, first + y); });
    bytes += pack(encoder, band)->size();
  }
  EXPECT_LT(8 * kRate_hz * double(bytes), 10e6);
}

TEST(CompactDepth, isTheSameForTheSameBandWhateverCameBefore) {
  BytePool pool(4);
  CompactDepthEncoder used(pool);
  CompactDepthEncoder fresh(pool);
  const Depth depth = depthOf(40, 20, [](uint32_t x, uint32_t y) { return 0.5 + 0.01 * x * y; });
  pack(used, depthOf(90, 60, [](uint32_t x, uint32_t) { return 3.0 * x; }));
  EXPECT_EQ(*pack(used, depth), *pack(fresh, depth));
}

TEST(CompactDepth, takesWhatIsNoDistanceAsInfinitelyFar) {
  BytePool pool(4);
  CompactDepthEncoder encoder(pool);
  const float odd[] = {0, -1, std::numeric_limits<float>::quiet_NaN(),
                       std::numeric_limits<float>::infinity(),
                       std::numeric_limits<float>::denorm_min()};
  const Depth nothing = depthOf(10, 2, [&](uint32_t x, uint32_t) { return odd[x / 2]; });
  const Depth unpacked = unpack(*pack(encoder, nothing), 5, 1);
  EXPECT_EQ(unpacked.inv_z, std::vector<float>(5, 0));
  const Depth some = depthOf(10, 2, [&](uint32_t x, uint32_t) { return x < 8 ? odd[x / 2] : 2; });
  EXPECT_EQ(unpack(*pack(encoder, some), 5, 1).inv_z, (std::vector<float>{0, 0, 0, 0, 2}));
}

}  // namespace
}  // namespace viewloom::compact_depth_test
