// SPDX-License-Identifier: Apache-2.0
#include "deep/split_pixel.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include <glm/geometric.hpp>

#include "deep/tidy_pixel.h"
#include "support/deep_composite.h"

namespace viewloom::deep::split_pixel_test {
namespace {

DeepPoint surface(double inv_z, double alpha) {
  return {.inv_z = inv_z, .alpha = alpha, .color = {alpha, 0.5 * alpha, 0}};
}

TEST(SplitPixel, leavesAPixelThatFitsAsItIs) {
  const std::vector<DeepPoint> points = {surface(1, 0.5), surface(0.5, 1)};
  const SplitPixel pixel = PixelSplitter(2).split(points);
  ASSERT_EQ(pixel.layer_count, 2U);
  EXPECT_FALSE(pixel.is_merged);
  EXPECT_EQ(pixel.error_per_m, 0);
  for (size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(pixel.layers[i].inv_z, points[i].inv_z);
    EXPECT_EQ(pixel.layers[i].alpha, points[i].alpha);
    EXPECT_EQ(pixel.layers[i].color, points[i].color);
  }
}

TEST(SplitPixel, takesPointsWithinAThousandthForOneSurface) {
  const std::vector<DeepPoint> points = {surface(1, 0.5), surface(0.9995, 0.5), surface(0.998, 1)};
  const SplitPixel pixel = PixelSplitter(2).split(points);
  ASSERT_EQ(pixel.layer_count, 2U);
  EXPECT_FALSE(pixel.is_merged) << "it was one surface";
  EXPECT_NEAR(pixel.layers[0].alpha, 0.75, 1e-12);
  EXPECT_NEAR(pixel.layers[0].inv_z, (0.5 + 0.25 * 0.9995) / 0.75, 1e-12);
  EXPECT_EQ(pixel.layers[1].inv_z, 0.998);
}

TEST(SplitPixel, hasNoLayerWithoutAPoint) {
  EXPECT_EQ(PixelSplitter(4).split({}).layer_count, 0U);
}

TEST(SplitPixel, showsWhatTheDeepPixelShows) {
  const unsigned seed = 815;
  std::mt19937 random(seed);
  const auto chance = [&] { return std::uniform_real_distribution<float>(0, 1)(random); };
  PixelTidier tidier;
  for (int round = 0; round < 2000; ++round) {
    // Up to 300: also more than are partitioned.
    std::vector<DeepSample> samples(1 + random() % (round % 20 == 0 ? 300 : 12));
    for (DeepSample& sample : samples) {
      sample.z_m = 0.5F + 20 * chance();
      sample.z_back_m = sample.z_m + (random() % 3 == 0 ? 3 * chance() : 0);
      sample.alpha = random() % 9 == 0 ? 1 : chance() / static_cast<float>(samples.size());
      sample.color = sample.alpha * glm::vec3(chance(), chance(), chance());
    }
    const auto points = tidier.tidy(samples);
    const uint32_t layer_count_max = 1 + round % 4;
    const SplitPixel pixel = PixelSplitter(layer_count_max).split(points);
    ASSERT_LE(pixel.layer_count, layer_count_max);
    ASSERT_EQ(pixel.is_merged, pixel.error_per_m > 0);
    // `over` is associative; what is left is the rounding of some thousand products below one.
    const auto layers = std::span(pixel.layers).first(pixel.layer_count);
    ASSERT_LT(glm::length(compositeOf(layers) - compositeOf(points)), 1e-12) << seed << round;
    for (size_t i = 1; i < layers.size(); ++i) {
      ASSERT_LT(layers[i].inv_z, layers[i - 1].inv_z);
    }
  }
}

}  // namespace
}  // namespace viewloom::deep::split_pixel_test
