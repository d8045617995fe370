// SPDX-License-Identifier: Apache-2.0
// FLIP of pictures for which its formulas can be solved by hand.
#include "scoring/flip.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace viewloom::flip_test {
namespace {

constexpr SizePx kSize = {64, 48};
// Single precision through a cube root and a power of 0.7 that is steep near 0.
constexpr double kRounding = 1e-4;

// The largest colour difference, to the 0.7: from published CIELAB values of the primaries (sRGB
// green 87.735, -86.183, 83.179; blue 32.297, 79.188, -107.860), chroma times lightness / 100.
const double kLargest = std::pow(
    87.735 - 32.297 +
        std::hypot(0.87735 * -86.183 - 0.32297 * 79.188, 0.87735 * 83.179 + 0.32297 * 107.860),
    0.7);

template <typename Value>
std::vector<float> pictureOf(Value value) {
  std::vector<float> rgb;
  for (uint32_t y = 0; y < kSize.height; ++y) {
    for (uint32_t x = 0; x < kSize.width; ++x) {
      for (uint32_t c = 0; c < 3; ++c) rgb.push_back(value(x, y, c));
    }
  }
  return rgb;
}

std::vector<float> flat(float r, float g, float b) {
  return pictureOf([=](uint32_t, uint32_t, uint32_t c) { return c == 0 ? r : c == 1 ? g : b; });
}

double lightnessOf(double luminance) {
  return 116 * std::cbrt(luminance) - 16;  // above 0.0089
}

double colorErrorOf(double difference) {
  const double knee = 0.4 * kLargest;
  const double d = std::pow(difference, 0.7);
  return d < knee ? 0.95 * d / knee : 0.95 + 0.05 * (d - knee) / (kLargest - knee);
}

void expectEverywhere(const std::vector<float>& map, double expected) {
  ASSERT_EQ(map.size(), kSize.area());
  for (const float value : map) ASSERT_NEAR(value, expected, kRounding);
}

TEST(Flip, ofAPictureWithItselfIsNothing) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> value(0, 1);
  const auto noise = pictureOf([&](uint32_t, uint32_t, uint32_t) { return value(random); });
  expectEverywhere(flipMap(noise, noise, kSize), 0);
}

TEST(Flip, ofFlatGreysIsThatOfTheirLightness) {
  // Below the knee and above it.
  expectEverywhere(flipMap(flat(0.2F, 0.2F, 0.2F), flat(0.25F, 0.25F, 0.25F), kSize),
                   colorErrorOf(lightnessOf(0.25) - lightnessOf(0.2)));
  expectEverywhere(flipMap(flat(0, 0, 0), flat(1, 1, 1), kSize), colorErrorOf(100));
}

TEST(Flip, ofGreenAndBlueIsTheLargest) {
  expectEverywhere(flipMap(flat(0, 1, 0), flat(0, 0, 1), kSize), 1);
}

TEST(Flip, weighsChromaByLightness) {
  // Two colours of one luminance: red's difference to grey is its chroma times its lightness.
  constexpr double kLuminance = 0.2126729;  // of (1, 0, 0)
  const auto grey = static_cast<float>(kLuminance);
  const double red_lightness = 53.241;
  const double red_chroma = std::hypot(80.092, 67.203);
  expectEverywhere(flipMap(flat(1, 0, 0), flat(grey, grey, grey), kSize),
                   colorErrorOf(red_lightness / 100 * red_chroma));
}

TEST(Flip, holdsLightWithinItsRange) {
  expectEverywhere(flipMap(flat(2, 2, 2), flat(1, 1, 1), kSize), 0);
  expectEverywhere(flipMap(flat(-1, 0, 0), flat(0, 0, 0), kSize), 0);
}

TEST(Flip, seesAnEdgeThatIsNotThere) {
  // A step between columns against its darker side. The derivative's weights sum to 1 on each
  // side of 0 and are 0 in the middle, so both pixels at the step are an edge of its whole height;
  // the second derivative's are the same on both sides, so a step is half a point's height:
  // whole positive weights 1, whole negative ones -1, and the middle one on the side of the pixel.
  constexpr uint32_t kStep_px = 32;
  constexpr double kDark = 0.2;
  constexpr double kBright = 0.4;
  const auto step = pictureOf(
      [](uint32_t x, uint32_t, uint32_t) { return float(x < kStep_px ? kDark : kBright); });
  const auto dark = flat(float(kDark), float(kDark), float(kDark));
  const std::vector<float> map = flipMap(step, dark, kSize);

  // Perceived light at the first bright pixel: a Gaussian of the distance in degrees with
  // b = 0.0047, out to three deviations of the widest Gaussian, b = 0.04.
  const double sigma_px = std::sqrt(0.0047 / 2) / std::numbers::pi * kFlipPxPerDegree;
  double all = 0;
  double bright = 0;
  for (int x = -10; x <= 10; ++x) {
    const double weight = std::exp(-x * x / (2 * sigma_px * sigma_px));
    all += weight;
    if (x >= 0) bright += weight;
  }
  const double seen = kDark + (kBright - kDark) * bright / all;
  const double color_error = colorErrorOf(lightnessOf(seen) - lightnessOf(kDark));
  const double feature_error = std::sqrt((kBright - kDark) / std::numbers::sqrt2);
  const double expected = std::pow(color_error, 1 - feature_error);
  for (uint32_t y = 0; y < kSize.height; ++y) {
    ASSERT_NEAR(map[y * kSize.width + kStep_px], expected, kRounding);
    ASSERT_NEAR(map[y * kSize.width], 0, kRounding) << "far from the step";
  }
}

TEST(Flip, overlooksFromAfarWhatIsPlainNearby) {
  const auto checks =
      pictureOf([](uint32_t x, uint32_t y, uint32_t) { return (x + y) % 2 == 0 ? 0.4F : 0.6F; });
  const auto grey = flat(0.5F, 0.5F, 0.5F);
  const size_t middle = size_t{24} * kSize.width + 32;
  const double near_by = flipMap(checks, grey, kSize, 10)[middle];
  const double from_afar = flipMap(checks, grey, kSize, 200)[middle];
  EXPECT_GT(near_by, 0.3);
  EXPECT_LT(from_afar, 0.01);
}

}  // namespace
}  // namespace viewloom::flip_test
