// SPDX-License-Identifier: Apache-2.0
// From where the source stands, the truth is the frame itself.
#include <gtest/gtest.h>

#include <cstring>

#include "bench/bench_frames.h"
#include "bench/true_views.h"
#include "synthetic/synthetic_frame.h"

namespace viewloom::bench::true_views_test {
namespace {

constexpr SizePx kSize_px{192, 108};

std::vector<uint32_t> colorOf(const Frame& frame) {
  const std::vector<uint8_t>& bytes = *frame.sources.front().front().color;
  std::vector<uint32_t> rgba(bytes.size() / 4);
  std::memcpy(rgba.data(), bytes.data(), bytes.size());
  return rgba;
}

int largestDifference(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b) {
  int largest = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    for (int shift = 0; shift < 32; shift += 8) {
      largest = std::max(largest, std::abs(int(a[i] >> shift & 255U) - int(b[i] >> shift & 255U)));
    }
  }
  return largest;
}

// Places that are computed in another order may round a colour to the next code.
constexpr int kRounding_codes = 1;

TEST(TrueViews, areTheFrameWhereTheSourceStands) {
  const Camera camera = syntheticCamera(kSize_px);
  EXPECT_EQ(trueClutter(camera, kSize_px, kSize_px), colorOf(*clutterFrame(kSize_px, 1)));
  EXPECT_LE(
      largestDifference(trueSmooth(camera, kSize_px, kSize_px), colorOf(*smoothFrame(kSize_px, 1))),
      kRounding_codes);
  EXPECT_LE(
      largestDifference(trueThin(camera, kSize_px, kSize_px), colorOf(*thinFrame(kSize_px, 1))),
      kRounding_codes);
}

// Those of which the frame has the centre: px are three times as large on a side.
TEST(TrueViews, seeTexturesAsSharpInLargerPixels) {
  Camera camera = syntheticCamera(kSize_px);
  const SizePx small_px{kSize_px.width / 3, kSize_px.height / 3};
  camera.intrinsics.focal_px /= 3;
  camera.intrinsics.principal_px /= 3;
  const std::vector<uint32_t> fine = colorOf(*clutterFrame(kSize_px, 1));
  std::vector<uint32_t> middles;
  for (uint32_t y = 0; y < small_px.height; ++y) {
    for (uint32_t x = 0; x < small_px.width; ++x) {
      middles.push_back(fine[size_t{3 * y + 1} * kSize_px.width + 3 * x + 1]);
    }
  }
  EXPECT_EQ(trueClutter(camera, small_px, kSize_px), middles);
}

// A view of columns a quarter of a px wide, of which each shows its own code.
std::vector<uint32_t> quarterColumns(const Camera& /*view*/, SizePx view_px) {
  std::vector<uint32_t> rgba;
  for (uint32_t y = 0; y < view_px.height; ++y) {
    for (uint32_t x = 0; x < view_px.width; ++x) {
      const bool is_known = y != 5 || x != 2;
      rgba.push_back(10 * x | (20 * y + x) << 8 | (is_known ? 0xff000000U : 0));
    }
  }
  return rgba;
}

TEST(TrueViews, showTheMeanOfAllThatAPixelCovers) {
  const std::vector<uint32_t> rgba = meanView(quarterColumns, syntheticCamera(kSize_px), {3, 2});
  ASSERT_EQ(rgba.size(), 6U);
  for (uint32_t px = 0; px < 6; ++px) {
    const uint32_t column = px % 3;
    const uint32_t row = px / 3;
    // Halves are rounded up.
    EXPECT_EQ(rgba[px] & 255U, 40 * column + 15) << px;
    EXPECT_EQ(rgba[px] >> 8 & 255U, 80 * row + 30 + 4 * column + 2) << px;
    EXPECT_EQ(rgba[px] >> 24, px == 3 ? 0U : 255U) << px;
  }
}

TEST(TrueViews, knowWhatTheImageDoesNotReach) {
  Camera camera = syntheticCamera(kSize_px);
  camera.intrinsics.principal_px.x += 10;  // sees so much more on the left
  const std::vector<uint32_t> rgba = trueSmooth(camera, kSize_px, kSize_px);
  for (uint32_t x = 0; x < kSize_px.width; ++x) {
    EXPECT_EQ(rgba[x] >> 24, x < 10 ? 0U : 255U) << x;
  }
}

}  // namespace
}  // namespace viewloom::bench::true_views_test
