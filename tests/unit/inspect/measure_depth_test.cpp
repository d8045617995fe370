// SPDX-License-Identifier: Apache-2.0
#include "inspect/measure_depth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "unit/inspect/depth_planes.h"

namespace viewloom::inspect::measure_depth_test {
namespace {

using test::depthPlane;
using test::DepthPlane;

DepthSamples samplesOf(const DepthPlane& made) {
  v1::Camera camera;
  camera.mutable_intrinsics()->set_focal_x_px(100);
  camera.mutable_intrinsics()->set_focal_y_px(100);
  auto samples = readDepthSamples(made.plane, made.bytes, camera);
  EXPECT_TRUE(samples.ok()) << samples.status();
  return samples.ok() ? *std::move(samples) : DepthSamples{};
}

TEST(DepthSamples, countWhatTheyAre) {
  DepthPlane made = depthPlane<float>(8, 1, v1::DEPTH_MEANING_PLANAR, [](uint32_t x, uint32_t) {
    const float special[8] = {0,
                              -1,
                              std::numeric_limits<float>::quiet_NaN(),
                              std::numeric_limits<float>::infinity(),
                              7,
                              1e10F,
                              2,
                              4};
    return special[x];
  });
  made.plane.mutable_depth()->set_invalid_value(7);
  const DepthSamples samples = samplesOf(made);
  EXPECT_EQ(samples.invalid_count, 2U) << "metric 0, and 7";
  EXPECT_EQ(samples.bad_count, 2U);
  EXPECT_EQ(samples.sky_count, 1U);
  EXPECT_EQ(samples.surface_count, 3U);
  EXPECT_EQ(samples.huge.count, 1U);
  EXPECT_EQ(samples.stored_min, 2);
  EXPECT_EQ(samples.stored_max, 1e10F);
  EXPECT_EQ(samples.inv_z[7], 0.25F);
  made.plane.mutable_depth()->set_invalid_is_far(true);
  EXPECT_EQ(samplesOf(made).sky_count, 2U);
}

TEST(DepthSamples, refuseFormatsThatCannotBe) {
  DepthPlane made =
      depthPlane<float>(1, 1, v1::DEPTH_MEANING_WINDOW, [](uint32_t, uint32_t) { return 0.5F; });
  EXPECT_THAT(std::string(readDepthSamples(made.plane, made.bytes, {}).status().message()),
              ::testing::HasSubstr("depth.near_z_m: the near plane is at 0 m"));
}

// Codes of 1/Z that round a slope: what is measured is the step of the codes.
TEST(MeasureDepth, findsTheStepOfCodes) {
  DepthPlane made =
      depthPlane<uint16_t>(256, 128, v1::DEPTH_MEANING_DISPARITY, [](uint32_t x, uint32_t y) {
        return static_cast<uint16_t>(40 + std::lround(0.31 * x + 0.17 * y));
      });
  made.plane.mutable_depth()->set_scale(0.01);
  const DepthMeasures measures = measureDepth(samplesOf(made));
  EXPECT_NEAR(measures.step, 0.01, 1e-6);
  EXPECT_NEAR(measures.inv_z_min, 0.4, 1e-6);
  EXPECT_NEAR(measures.inv_z_max, 1.41, 1e-2);
}

// Independent normal noise: its standard deviation.
TEST(MeasureDepth, findsTheNoiseOfASlope) {
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0, 0.003F);
  const DepthPlane made =
      depthPlane<float>(512, 512, v1::DEPTH_MEANING_DISPARITY, [&](uint32_t x, uint32_t y) {
        return 0.5F + 0.001F * float(x) + 0.0005F * float(y) + noise(random);
      });
  // 16384 differences: the median is known to 1.2 %.
  EXPECT_NEAR(measureDepth(samplesOf(made)).noise_sigma, 0.003, 0.003 * 0.05);
}

TEST(MeasureDepth, findsNoNoiseInFlatSurfacesAndSkies) {
  const DepthPlane made = depthPlane<float>(
      64, 64, v1::DEPTH_MEANING_PLANAR,
      [](uint32_t x, uint32_t) { return x < 32 ? 2 : std::numeric_limits<float>::infinity(); });
  const DepthMeasures measures = measureDepth(samplesOf(made));
  EXPECT_EQ(measures.noise_sigma, 0);
  EXPECT_EQ(measures.inv_z_median, 0.5F);
}

TEST(MeasureDepth, hasNothingToSayWithoutSurface) {
  const DepthPlane made =
      depthPlane<float>(9, 5, v1::DEPTH_MEANING_PLANAR, [](uint32_t, uint32_t) { return 0.0F; });
  const DepthMeasures measures = measureDepth(samplesOf(made));
  EXPECT_EQ(measures.inv_z_max, 0);
  EXPECT_EQ(measures.step, 0);
}

}  // namespace
}  // namespace viewloom::inspect::measure_depth_test
