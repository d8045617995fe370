// SPDX-License-Identifier: Apache-2.0
// Depth is made here the way cameras and graphics libraries make it, from a known Z, and must come
// back as 1/Z.
#include "frame/depth.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "support/depth_reference.h"

namespace viewloom::depth_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr Intrinsics kCamera{.focal_px = {800, 700}, .principal_px = {310.5, 200.25}};
constexpr PlaneEncoding kF32 = PlaneEncoding::kDepthF32;
constexpr PlaneEncoding kU16 = PlaneEncoding::kDepthU16;

DepthValue decode(const DepthFormat& format, double sample, PlaneEncoding encoding = kF32,
                  glm::uvec2 pixel_px = {0, 0}) {
  return linearizeDepth(format, encoding, sample, pixel_px, kCamera);
}

void expectSurface(const DepthValue& value, double inv_z, double relative_error = 1e-12) {
  EXPECT_EQ(value.kind, DepthClass::kSurface);
  EXPECT_NEAR(value.inv_z, inv_z, std::abs(inv_z) * relative_error);
}

// The z row of an OpenGL-style projection matrix with a clip range of [0, 1], mapped to [a, b].
double windowDepth(double z_m, const DepthFormat& format) {
  const double n = format.near_z_m;
  const double f = format.far_z_m;
  double ndc = f / (f - n) - f * n / ((f - n) * z_m);
  if (std::isinf(f)) ndc = 1 - n / z_m;
  if (std::isinf(n)) ndc = f / z_m;  // reversed, infinite: the far end is at 0
  if (n > f && !std::isinf(n)) {
    // Reversed: near_z_m is the distant plane, and lies at min_depth.
    ndc = (1 / z_m - 1 / n) / (1 / f - 1 / n);
  }
  return format.min_depth + (format.max_depth - format.min_depth) * ndc;
}

TEST(LinearizeDepth, readsPlanarMetresAndMillimetres) {
  expectSurface(decode({.meaning = DepthMeaning::kPlanar}, 4), 0.25);
  expectSurface(decode({.meaning = DepthMeaning::kPlanar, .scale = 0.001}, 2500, kU16), 0.4);
  expectSurface(decode({.meaning = DepthMeaning::kPlanar, .scale = -1, .offset = 1}, -1), 0.5);
}

TEST(LinearizeDepth, readsTheDistanceOfAPointAlongItsRay) {
  const glm::dvec2 point_m{0.7, -0.4};  // camera space, x right, y up
  const double z_m = 3;
  const glm::dvec2 at_px =
      kCamera.principal_px + glm::dvec2(point_m.x, -point_m.y) / z_m * kCamera.focal_px;
  const glm::uvec2 pixel_px(at_px);
  // The point in that direction whose image is the pixel's centre.
  const glm::dvec2 ray = (glm::dvec2(pixel_px) + 0.5 - kCamera.principal_px) / kCamera.focal_px;
  const double distance_m = glm::length(glm::dvec3(ray * z_m, z_m));
  const DepthFormat format{.meaning = DepthMeaning::kRayDistance, .scale = 0.01};
  expectSurface(decode(format, distance_m * 100, kF32, pixel_px), 1 / z_m);
}

TEST(LinearizeDepth, readsWindowDepthOfEveryProjection) {
  const std::vector<std::pair<double, double>> planes{
      {0.1, 100}, {0.1, kInf}, {100, 0.1}, {kInf, 0.1}};
  for (const auto& [near_z_m, far_z_m] : planes) {
    for (const auto& [min_depth, max_depth] : {std::pair{0.0, 1.0}, std::pair{0.25, 0.75}}) {
      const DepthFormat format{.meaning = DepthMeaning::kWindow,
                               .min_depth = min_depth,
                               .max_depth = max_depth,
                               .near_z_m = near_z_m,
                               .far_z_m = far_z_m};
      for (const double z_m : {0.1, 0.5, 7.0, 99.0}) {
        expectSurface(decode(format, windowDepth(z_m, format)), 1 / z_m, 1e-9);
        expectSurface(decode(format, windowDepth(z_m, format) * 65535, kU16), 1 / z_m, 1e-9);
      }
    }
  }
}

TEST(LinearizeDepth, findsTheSkyAtAnInfiniteFarPlaneWhateverTheRounding) {
  for (const float bound : {0.9F, 0.3F, 0.1F}) {
    const DepthFormat forward{.meaning = DepthMeaning::kWindow,
                              .max_depth = double{bound},
                              .near_z_m = 0.1,
                              .far_z_m = kInf};
    const DepthFormat reversed{.meaning = DepthMeaning::kWindow,
                               .min_depth = double{bound},
                               .near_z_m = kInf,
                               .far_z_m = 0.1};
    EXPECT_EQ(decode(forward, double{bound}).kind, DepthClass::kSurface);
    EXPECT_EQ(decode(forward, double{bound}).inv_z, 0);
    EXPECT_EQ(decode(reversed, double{bound}).kind, DepthClass::kSurface);
    EXPECT_EQ(decode(reversed, double{bound}).inv_z, 0);
  }
}

TEST(LinearizeDepth, readsDisparityWithScaleAndOffset) {
  const DepthFormat format{.meaning = DepthMeaning::kDisparity, .scale = 0.5, .offset = 0.1};
  expectSurface(decode(format, 3), 1.6);
  expectSurface(decode({.meaning = DepthMeaning::kDisparity, .scale = 1.0 / 255}, 51, kU16), 0.2);
}

TEST(LinearizeDepth, takesWhatIsInfinitelyFarForTheSky) {
  for (const DepthMeaning meaning : {DepthMeaning::kPlanar, DepthMeaning::kRayDistance}) {
    const DepthValue value = decode({.meaning = meaning}, kInf);
    EXPECT_EQ(value.kind, DepthClass::kSurface);
    EXPECT_EQ(value.inv_z, 0);
  }
  const DepthValue disparity = decode({.meaning = DepthMeaning::kDisparity}, 0);
  EXPECT_EQ(disparity.kind, DepthClass::kSurface);
  EXPECT_EQ(disparity.inv_z, 0);
}

TEST(LinearizeDepth, seesNoSurfaceInBadSamples) {
  for (const DepthMeaning meaning : {DepthMeaning::kPlanar, DepthMeaning::kRayDistance,
                                     DepthMeaning::kDisparity, DepthMeaning::kWindow}) {
    const DepthFormat format{.meaning = meaning, .near_z_m = 0.1, .far_z_m = kInf};
    EXPECT_EQ(decode(format, kNan).kind, DepthClass::kBad);
    EXPECT_EQ(decode(format, -kInf).kind, DepthClass::kBad);
  }
  EXPECT_EQ(decode({.meaning = DepthMeaning::kPlanar}, -1).kind, DepthClass::kBad);
  EXPECT_EQ(decode({.meaning = DepthMeaning::kPlanar}, 1e-30).kind, DepthClass::kBad);
  EXPECT_EQ(decode({.meaning = DepthMeaning::kDisparity}, -0.5).kind, DepthClass::kBad);
  EXPECT_EQ(decode({.meaning = DepthMeaning::kDisparity}, kInf).kind, DepthClass::kBad);
  EXPECT_EQ(decode({.meaning = DepthMeaning::kPlanar}, 0).kind, DepthClass::kNoSurface);
  EXPECT_EQ(decode({.meaning = DepthMeaning::kRayDistance}, 0).kind, DepthClass::kNoSurface);
}

TEST(LinearizeDepth, letsTheInvalidValueMeanNothingOrTheSky) {
  DepthFormat format{.meaning = DepthMeaning::kPlanar, .invalid_value = 0};
  EXPECT_EQ(decode(format, 0).kind, DepthClass::kNoSurface);
  format.invalid_is_far = true;
  EXPECT_EQ(decode(format, 0).kind, DepthClass::kSurface);
  EXPECT_EQ(decode(format, 0).inv_z, 0);
  expectSurface(decode(format, 2), 0.5);
}

TEST(LinearizeDepth, matchesTheInvalidValueAsTheSampleHoldsIt) {
  const DepthFormat format{.meaning = DepthMeaning::kPlanar, .invalid_value = 0.1};
  EXPECT_EQ(decode(format, double{0.1F}, kF32).kind, DepthClass::kNoSurface);
  // 0.1 as binary16 is 0.0999755859375.
  EXPECT_EQ(decode(format, 0.0999755859375, PlaneEncoding::kDepthF16).kind, DepthClass::kNoSurface);
  EXPECT_EQ(decode(format, 0.1000, kF32).kind, DepthClass::kSurface);
}

// Decodes depth with the coefficients as a kernel does, in its precision.
DepthValue decodeAsKernel(const DepthCoefficients& c, float sample, glm::uvec2 pixel_px) {
  if (c.has_invalid != 0 && sample == c.invalid_value) {
    return {.kind = c.invalid_is_far != 0 ? DepthClass::kSurface : DepthClass::kNoSurface};
  }
  const float value = (sample - c.origin) * c.scale + c.offset;
  if (c.reciprocal != 0 && value == 0) return {.kind = DepthClass::kNoSurface};
  if (!(value >= 0)) return {.kind = DepthClass::kBad};
  float inv_z = c.reciprocal != 0 ? 1 / value : value;
  if (c.ray_distance != 0) {
    const glm::vec2 ray = (glm::vec2(pixel_px) + 0.5F - glm::vec2(kCamera.principal_px)) /
                          glm::vec2(kCamera.focal_px);
    inv_z *= glm::length(glm::vec3(ray, 1));
  }
  if (!(inv_z <= c.inv_z_max)) return {.kind = DepthClass::kBad};
  return {.kind = DepthClass::kSurface, .inv_z = double{inv_z}};
}

TEST(DepthCoefficients, giveAKernelWhatTheReferenceGives) {
  const std::vector<DepthFormat> formats{
      {.meaning = DepthMeaning::kPlanar},
      {.meaning = DepthMeaning::kPlanar, .scale = 0.001, .invalid_value = 0},
      {.meaning = DepthMeaning::kPlanar, .invalid_value = 0, .invalid_is_far = true},
      {.meaning = DepthMeaning::kRayDistance, .scale = 0.01, .offset = 0.5},
      {.meaning = DepthMeaning::kDisparity, .scale = 0.25, .offset = 0.125},
      {.meaning = DepthMeaning::kWindow, .near_z_m = 0.1, .far_z_m = 50},
      {.meaning = DepthMeaning::kWindow, .near_z_m = 0.1, .far_z_m = kInf},
      {.meaning = DepthMeaning::kWindow, .near_z_m = kInf, .far_z_m = 0.1},
      {.meaning = DepthMeaning::kWindow,
       .min_depth = 0.2,
       .max_depth = 0.9,
       .near_z_m = 50,
       .far_z_m = 0.1},
  };
  // Four roundings to binary32; window depth loses more where 1/Z nears that of the far end.
  constexpr double kRelative = 1e-6;
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit(0, 1);
  for (const DepthFormat& format : formats) {
    for (const PlaneEncoding encoding : {kF32, kU16}) {
      const DepthCoefficients coefficients = makeDepthCoefficients(format, encoding);
      const double largest = std::abs(double{coefficients.scale} * 65536) + 10;
      for (int i = 0; i < 1000; ++i) {
        const float sample = i == 0             ? 0
                             : encoding == kU16 ? std::floor(unit(random) * 65536)
                             : i < 500          ? unit(random)
                                                : -unit(random) * 3;
        const glm::uvec2 pixel_px{i % 640, i % 480};
        const DepthValue want = linearizeDepth(format, encoding, double{sample}, pixel_px, kCamera);
        const DepthValue got = decodeAsKernel(coefficients, sample, pixel_px);
        EXPECT_EQ(got.kind, want.kind) << "sample " << sample;
        const bool window = format.meaning == DepthMeaning::kWindow;
        const double scale = window ? largest : want.inv_z;
        EXPECT_NEAR(got.inv_z, want.inv_z, scale * kRelative) << "sample " << sample;
      }
    }
  }
}

}  // namespace
}  // namespace viewloom::depth_test
