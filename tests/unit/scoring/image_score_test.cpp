// SPDX-License-Identifier: Apache-2.0
// Scores of pictures for which the formulas have a closed form.
#include "scoring/image_score.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace viewloom::image_score_test {
namespace {

constexpr SizePx kSize = {40, 30};

template <typename Value>
ScoredImage imageOf(Value value) {
  ScoredImage image = {.size_px = kSize, .rgb = {}};
  for (uint32_t y = 0; y < kSize.height; ++y) {
    for (uint32_t x = 0; x < kSize.width; ++x) {
      for (uint32_t c = 0; c < 3; ++c) image.rgb.push_back(value(x, y, c));
    }
  }
  return image;
}

ScoredImage greyOf(float grey) {
  return imageOf([grey](uint32_t, uint32_t, uint32_t) { return grey; });
}

ScoredImage noiseOf(uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(0, 1);
  return imageOf([&](uint32_t, uint32_t, uint32_t) { return value(random); });
}

ImageComparison compare(const ScoredImage& got, const ScoredImage& truth) {
  return {got, truth, ScoreTransfer::kSrgb};
}

ImageScore scoreAll(const ScoredImage& got, const ScoredImage& truth) {
  const std::vector<uint8_t> everything(kSize.area(), 1);
  return compare(got, truth).score(everything, kSize.area());
}

TEST(ImageScore, ofAPictureWithItselfIsPerfect) {
  const ScoredImage noise = noiseOf(1);
  const ImageScore score = scoreAll(noise, noise);
  EXPECT_EQ(score.psnr_db, INFINITY);
  EXPECT_DOUBLE_EQ(score.ssim, 1);
  EXPECT_EQ(score.share, 1);
  EXPECT_EQ(score.pixel_count, kSize.area());
}

TEST(ImageScore, ofAConstantErrorIsItsSize) {
  // An error of 1/10 everywhere: 20 dB. In one of three channels: its square a third.
  EXPECT_NEAR(scoreAll(greyOf(0.5F), greyOf(0.6F)).psnr_db, 20, 1e-5);
  const ScoredImage red =
      imageOf([](uint32_t, uint32_t, uint32_t c) { return c == 0 ? 0.6F : 0.5F; });
  EXPECT_NEAR(scoreAll(greyOf(0.5F), red).psnr_db, 20 + 10 * std::log10(3.0), 1e-5);
}

TEST(ImageScore, ofFlatPicturesIsTheSsimOfTheirMeans) {
  const double a = 0.3F;
  const double b = 0.7F;
  const double expected = (2 * a * b + 1e-4) / (a * a + b * b + 1e-4);
  EXPECT_NEAR(scoreAll(greyOf(0.3F), greyOf(0.7F)).ssim, expected, 1e-12);
}

TEST(ImageScore, ofScaledRampsIsTheSsimOfTheirVariances) {
  // In the middle of a ramp the window's mean is the value itself and the variance slope^2 times
  // that of the window; a ramp of half the slope around the same value has half of each deviation.
  const uint32_t middle = 20;
  const auto ramp = [&](double slope) {
    return imageOf([=](uint32_t x, uint32_t, uint32_t) {
      return static_cast<float>(0.5 + slope * (double(x) - middle));
    });
  };
  double weight_sum = 0;
  double window_variance = 0;
  for (int i = -5; i <= 5; ++i) {
    const double weight = std::exp(-i * i / 4.5);
    weight_sum += weight;
    window_variance += weight * i * i;
  }
  window_variance /= weight_sum;
  const double var_a = 0.02 * 0.02 * window_variance;
  const double var_b = 0.01 * 0.01 * window_variance;
  const double covariance = 0.02 * 0.01 * window_variance;
  const double expected = (2 * covariance + 9e-4) / (var_a + var_b + 9e-4);
  std::vector<uint8_t> selected(kSize.area(), 0);
  for (uint32_t y = 0; y < kSize.height; ++y) selected[y * kSize.width + middle] = 1;
  const ImageScore score = compare(ramp(0.02), ramp(0.01)).score(selected, kSize.area());
  EXPECT_NEAR(score.ssim, expected, 1e-6);  // float samples
  EXPECT_EQ(score.pixel_count, kSize.height);
}

TEST(ImageScore, ofFlatPicturesIsTheFlipOfTheirLight) {
  // Greys of light 0.2 and 0.25, as each transfer has them; see flip_test.cpp for the value.
  const double difference = std::pow(116 * (std::cbrt(0.25) - std::cbrt(0.2)), 0.7);
  const double expected = 0.95 * difference / (0.4 * 41.28);
  for (const auto transfer : {ScoreTransfer::kSrgb, ScoreTransfer::kGamma22}) {
    const auto grey = [transfer](double light) {
      return greyOf(scoredSample(static_cast<float>(srgbFromLinear(light)), transfer));
    };
    const std::vector<uint8_t> everything(kSize.area(), 1);
    const ImageScore score =
        ImageComparison(grey(0.2), grey(0.25), transfer).score(everything, kSize.area());
    EXPECT_NEAR(score.flip, expected, 1e-3);
  }
}

TEST(ImageScore, countsOnlyTheSelectedPixels) {
  const ScoredImage got =
      imageOf([](uint32_t x, uint32_t, uint32_t) { return x < 10 ? 0.5F : 0.9F; });
  std::vector<uint8_t> left(kSize.area(), 0);
  for (uint32_t y = 0; y < kSize.height; ++y) {
    for (uint32_t x = 0; x < 10; ++x) left[y * kSize.width + x] = 255;
  }
  const ImageScore score = compare(got, greyOf(0.6F)).score(left, kSize.area());
  EXPECT_NEAR(score.psnr_db, 20, 1e-5);
  EXPECT_EQ(score.share, 0.25);
}

TEST(ImageScore, ofNoPixelIsNone) {
  const ScoredImage noise = noiseOf(1);
  const std::vector<uint8_t> nothing(kSize.area(), 0);
  const ImageScore score = compare(noise, noiseOf(2)).score(nothing, kSize.area());
  EXPECT_TRUE(std::isnan(score.psnr_db));
  EXPECT_TRUE(std::isnan(score.ssim));
  EXPECT_TRUE(std::isnan(score.flip));
  EXPECT_EQ(score.share, 0);
}

TEST(ImageScore, ofUnrelatedNoiseIsFarFromPerfect) {
  // Two independent uniform values differ by 1/6 in the mean of squares: 7.78 dB.
  const ImageScore score = scoreAll(noiseOf(1), noiseOf(2));
  EXPECT_NEAR(score.psnr_db, 10 * std::log10(6.0), 0.3);
  EXPECT_NEAR(score.ssim, 0, 0.1);
}

}  // namespace
}  // namespace viewloom::image_score_test
