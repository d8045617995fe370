// SPDX-License-Identifier: Apache-2.0
#include "deep/tidy_pixel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include <glm/geometric.hpp>

#include "support/deep_composite.h"

namespace viewloom::deep::tidy_pixel_test {
namespace {

// Some hundred operations on numbers of size one, in binary64.
constexpr double kRounding = 1e-12;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

double distance(const glm::dvec4& a, const glm::dvec4& b) {
  return glm::length(a - b);
}

// The reference: the rules of "Interpreting OpenEXR Deep Pixels", word by word and pair by pair.
struct Part {
  double begin_m, end_m;
  glm::dvec4 light;  // premultiplied
};

// The part of a volume sample in front of a share of its length.
glm::dvec4 frontOf(const glm::dvec4& light, double share) {
  const double alpha = 1 - std::pow(1 - light.a, share);
  return light.a > 0 ? glm::dvec4(glm::dvec3(light) * (alpha / light.a), alpha)
                     : glm::dvec4(glm::dvec3(light) * share, 0);
}

glm::dvec4 merged(const glm::dvec4& a, const glm::dvec4& b) {
  const double alpha = 1 - (1 - a.a) * (1 - b.a);
  if (a.a == 1 && b.a == 1) return {0.5 * (glm::dvec3(a) + glm::dvec3(b)), 1};
  if (a.a == 1) return {glm::dvec3(a), 1};
  if (b.a == 1) return {glm::dvec3(b), 1};
  const double u_a = -std::log(1 - a.a), u_b = -std::log(1 - b.a);
  const double v_a = a.a > 0 ? u_a / a.a : 1, v_b = b.a > 0 ? u_b / b.a : 1;
  const double w = u_a + u_b != 0 ? alpha / (u_a + u_b) : 1;
  return {w * (glm::dvec3(a) * v_a + glm::dvec3(b) * v_b), alpha};
}

glm::dvec4 flattened(const std::vector<DeepSample>& samples) {
  std::set<double> cuts;
  for (const DeepSample& sample : samples) {
    cuts.insert(sample.z_m);
    cuts.insert(std::max(sample.z_m, sample.z_back_m));
  }
  std::vector<Part> parts;
  for (const DeepSample& sample : samples) {
    Part rest{sample.z_m, std::max(sample.z_m, sample.z_back_m),
              glm::dvec4(sample.color, sample.alpha)};
    for (const double cut : cuts) {
      if (cut <= rest.begin_m || cut >= rest.end_m) continue;
      const double share = (cut - rest.begin_m) / (rest.end_m - rest.begin_m);
      parts.push_back({rest.begin_m, cut, frontOf(rest.light, share)});
      rest = {cut, rest.end_m, frontOf(rest.light, 1 - share)};
    }
    parts.push_back(rest);
  }
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
    return std::pair(a.begin_m, a.end_m) < std::pair(b.begin_m, b.end_m);
  });
  glm::dvec4 all(0);
  for (size_t i = 0; i < parts.size();) {
    glm::dvec4 light = parts[i].light;
    const Part first = parts[i];
    for (++i;
         i < parts.size() && parts[i].begin_m == first.begin_m && parts[i].end_m == first.end_m;
         ++i) {
      light = merged(light, parts[i].light);
    }
    all += (1 - all.a) * light;
  }
  return all;
}

TEST(TidyPixel, sortsPointsAndLeavesThemAsTheyAre) {
  PixelTidier tidier;
  const std::vector<DeepSample> samples = {
      {.z_m = 4, .z_back_m = 4, .alpha = 1, .color = {0.1F, 0.2F, 0.3F}},
      {.z_m = 2, .z_back_m = 1, .alpha = 0.25F, .color = {0.2F, 0.1F, 0}}};
  const auto points = tidier.tidy(samples);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].inv_z, 0.5);
  EXPECT_EQ(points[0].alpha, 0.25);
  EXPECT_EQ(points[0].color, glm::dvec3(samples[1].color)) << "a back before the front is none";
  EXPECT_EQ(points[1].inv_z, 0.25);
}

TEST(TidyPixel, cutsAVolumeIntoSlicesThatShowTheSame) {
  PixelTidier tidier;
  // From 1 m to 2 m: 1/Z falls by half, eight sixteenths.
  const DeepSample fog{.z_m = 1, .z_back_m = 2, .alpha = 0.75F, .color = {0.3F, 0.6F, 0.15F}};
  const auto points = tidier.tidy({&fog, 1});
  ASSERT_EQ(points.size(), 8U);
  EXPECT_LT(distance(compositeOf(points), glm::dvec4(fog.color, fog.alpha)), kRounding);
  double end_m = 1;
  for (size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(points[i].inv_z, 1 - (static_cast<double>(i) + 0.5) / 16, kRounding);
    const double begin_m = end_m;
    end_m = 1 / (1 - (static_cast<double>(i) + 1) / 16);
    // Each metre lets a quarter through.
    EXPECT_NEAR(points[i].alpha, 1 - std::pow(0.25, end_m - begin_m), kRounding);
  }
}

TEST(TidyPixel, keepsAThinVolumeWhole) {
  PixelTidier tidier;
  const DeepSample pane{.z_m = 1000,
                        .z_back_m = std::nextafter(1000.F, 2000.F),
                        .alpha = 0.5F,
                        .color = {0.5F, 0.25F, 0}};
  const auto points = tidier.tidy({&pane, 1});
  ASSERT_EQ(points.size(), 1U);
  EXPECT_LT(distance(compositeOf(points), {0.5, 0.25, 0, 0.5}), kRounding);
}

TEST(TidyPixel, mixesTwoFogsThatFillTheSameSpace) {
  PixelTidier tidier;
  // Equally dense: half of what is seen is the one's, half the other's.
  const std::vector<DeepSample> fogs = {
      {.z_m = 10, .z_back_m = 10.5F, .alpha = 0.5F, .color = {0.5F, 0, 0}},
      {.z_m = 10, .z_back_m = 10.5F, .alpha = 0.5F, .color = {0, 0.5F, 0}}};
  const auto points = tidier.tidy(fogs);
  EXPECT_LT(distance(compositeOf(points), {0.375, 0.375, 0, 0.75}), kRounding);
}

TEST(TidyPixel, putsAPointInsideAFogBetweenTwoPartsOfIt) {
  PixelTidier tidier;
  const std::vector<DeepSample> samples = {
      {.z_m = 10, .z_back_m = 10.5F, .alpha = 0.75F, .color = {0.75F, 0, 0}},
      {.z_m = 10.25F, .z_back_m = 10.25F, .alpha = 1, .color = {0, 1, 0}}};
  const auto points = tidier.tidy(samples);
  ASSERT_EQ(points.size(), 3U);
  EXPECT_NEAR(points[0].alpha, 0.5, kRounding) << "half of the way to 0.75";
  EXPECT_EQ(points[1].alpha, 1);
  EXPECT_NEAR(points[2].alpha, 0.5, kRounding);
  EXPECT_LT(distance(compositeOf(points), {0.5, 0.5, 0, 1}), kRounding);
}

TEST(TidyPixel, mergesPointsAtOneDepthInNoOrder) {
  PixelTidier tidier;
  const std::vector<DeepSample> opaque = {
      {.z_m = 3, .z_back_m = 3, .alpha = 1, .color = {1, 0, 0}},
      {.z_m = 3, .z_back_m = 3, .alpha = 1, .color = {0, 1, 0}},
      {.z_m = 3, .z_back_m = 3, .alpha = 0.5F, .color = {0, 0, 0.5F}}};
  const auto points = tidier.tidy(opaque);
  ASSERT_EQ(points.size(), 1U);
  EXPECT_LT(distance(compositeOf(points), {0.5, 0.5, 0, 1}), kRounding);
}

TEST(TidyPixel, takesVolumesWithoutADensityForPointsAtTheirFronts) {
  PixelTidier tidier;
  const std::vector<DeepSample> samples = {
      {.z_m = 2, .z_back_m = 4, .alpha = 1, .color = {1, 0, 0}},
      {.z_m = 1, .z_back_m = kInfinity, .alpha = 0.5F, .color = {0, 0.5F, 0}},
      {.z_m = kInfinity, .z_back_m = kInfinity, .alpha = 1, .color = {0, 0, 1}}};
  const auto points = tidier.tidy(samples);
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[0].inv_z, 1);
  EXPECT_EQ(points[1].inv_z, 0.5);
  EXPECT_EQ(points[2].inv_z, 0);
}

TEST(TidyPixel, dropsWhatHasNoPlaceAndTamesWhatIsNoNumber) {
  PixelTidier tidier;
  const std::vector<DeepSample> samples = {
      {.z_m = kNoNumber, .z_back_m = 1, .alpha = 1, .color = {1, 1, 1}},
      {.z_m = 0, .z_back_m = 1, .alpha = 1, .color = {1, 1, 1}},
      {.z_m = -kInfinity, .z_back_m = 1, .alpha = 1, .color = {1, 1, 1}},
      {.z_m = 1, .z_back_m = kNoNumber, .alpha = kNoNumber, .color = {kInfinity, kNoNumber, 0}},
      {.z_m = 2, .z_back_m = 2, .alpha = 7, .color = {1, 1, 1}},
      {.z_m = 3, .z_back_m = 3, .alpha = -1, .color = {0, 0, 0}}};
  const auto points = tidier.tidy(samples);
  EXPECT_EQ(tidier.droppedCount(), 3U);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].alpha, 0);
  EXPECT_EQ(points[0].color, glm::dvec3(65504, 0, 0));
  EXPECT_EQ(points[1].alpha, 1);
}

TEST(TidyPixel, flattensMessyPixelsAsOpenExrSays) {
  const unsigned seed = 20260;
  std::mt19937 random(seed);
  PixelTidier tidier;
  const auto chance = [&] { return std::uniform_real_distribution<float>(0, 1)(random); };
  for (int round = 0; round < 2000; ++round) {
    std::vector<DeepSample> samples(1 + random() % 8);
    for (DeepSample& sample : samples) {
      // Few depths, so that ends often meet; in eighths, which binary32 holds.
      sample.z_m = 1 + static_cast<float>(random() % 16) / 8;
      sample.z_back_m = sample.z_m + static_cast<float>(random() % 9) / 8;
      sample.alpha = std::min(1.2F * chance(), 0.999F);
      if (random() % 8 == 0) sample.alpha = 0;
      // Opaque points, too; an opaque volume is a point at its front, see the header.
      if (random() % 8 == 0) {
        sample.alpha = 1;
        sample.z_back_m = sample.z_m;
      }
      sample.color = {chance(), chance(), chance()};
    }
    const auto points = tidier.tidy(samples);
    ASSERT_LT(distance(compositeOf(points), flattened(samples)), kRounding * 100)
        << "seed " << seed << ", round " << round;
    ASSERT_TRUE(std::is_sorted(points.begin(), points.end(),
                               [](const auto& a, const auto& b) { return a.inv_z > b.inv_z; }));
  }
}

}  // namespace
}  // namespace viewloom::deep::tidy_pixel_test
