// SPDX-License-Identifier: Apache-2.0
// Alpha that makes views see through what has a surface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "inspect/suspicions.h"
#include "unit/inspect/depth_planes.h"

namespace viewloom::inspect::suspect_alpha_test {
namespace {

using test::depthPlane;
using test::DepthPlane;
using ::testing::IsEmpty;

constexpr uint32_t kWidth = 40, kHeight = 30;

struct AlphaOf {
  v1::AlphaMode mode;
  std::function<uint8_t(uint32_t x)> alpha;
  uint8_t color = 90;
};

std::vector<Suspicion> alphaSuspicions(const AlphaOf& its, float depth_m = 2) {
  const DepthPlane depth = depthPlane<float>(kWidth, kHeight, v1::DEPTH_MEANING_PLANAR,
                                             [depth_m](uint32_t, uint32_t) { return depth_m; });
  v1::Plane color;
  color.set_encoding(v1::PLANE_ENCODING_RGBA8);
  color.set_alpha(its.mode);
  *color.mutable_size() = depth.plane.size();
  std::vector<uint8_t> bytes;
  for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
    bytes.insert(bytes.end(), {its.color, its.color, its.color, its.alpha(i % kWidth)});
  }
  const auto samples = readDepthSamples(depth.plane, depth.bytes, {});
  EXPECT_TRUE(samples.ok());
  return suspectAlpha(color, measureAlpha(color, bytes, *samples));
}

TEST(SuspectAlpha, seesAlphaThatHidesEverything) {
  const auto none = [](uint32_t) { return uint8_t{0}; };
  const auto tiny = [](uint32_t) { return uint8_t{1}; };
  const auto half = [](uint32_t x) { return uint8_t(x < kWidth / 2 ? 0 : 255); };
  const auto full = [](uint32_t) { return uint8_t{255}; };
  EXPECT_EQ(alphaSuspicions({v1::ALPHA_MODE_PREMULTIPLIED, none}).size(), 1U);
  EXPECT_EQ(alphaSuspicions({v1::ALPHA_MODE_STRAIGHT, none}).size(), 1U);
  EXPECT_EQ(alphaSuspicions({v1::ALPHA_MODE_STRAIGHT, tiny}).size(), 1U);
  EXPECT_EQ(alphaSuspicions({v1::ALPHA_MODE_PREMULTIPLIED, half}).size(), 1U)
      << "light without alpha in a part";
  EXPECT_THAT(alphaSuspicions({v1::ALPHA_MODE_STRAIGHT, half}), IsEmpty()) << "a cut-out";
  EXPECT_THAT(alphaSuspicions({v1::ALPHA_MODE_PREMULTIPLIED, half, 0}), IsEmpty());
  EXPECT_THAT(alphaSuspicions({v1::ALPHA_MODE_PREMULTIPLIED, full}), IsEmpty());
  EXPECT_THAT(alphaSuspicions({v1::ALPHA_MODE_OPAQUE, none}), IsEmpty());
  EXPECT_THAT(alphaSuspicions({v1::ALPHA_MODE_PREMULTIPLIED, none}, 1e30F), IsEmpty())
      << "where a renderer hit nothing";
}

}  // namespace
}  // namespace viewloom::inspect::suspect_alpha_test
