// SPDX-License-Identifier: Apache-2.0
// The synthetic scene: what its layers promise, checked against geometry derived apart from it.
#include "synthetic/synthetic_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>

#include "synthetic/scene.h"

namespace viewloom::synthetic_frame_test {
namespace {

// The ground as the header states it: y = -0.85 - 0.06 z.
constexpr double kGroundY_m = -0.85;
constexpr double kGroundSlope = -0.06;
// binary32 keeps 24 bits of a depth below 8 m: 2^-22 m; squared up by a margin of two.
constexpr double kFloatDepthError_m = 1e-6;

glm::dvec3 rayOf(const Camera& camera, double x, double y) {
  const Intrinsics& pinhole = camera.intrinsics;
  const glm::dvec3 direction{(x + 0.5 - pinhole.principal_px.x) / pinhole.focal_px.x,
                             -(y + 0.5 - pinhole.principal_px.y) / pinhole.focal_px.y, -1.0};
  return camera.pose.orientation * direction;
}

TEST(SyntheticFrame, sortsTheLayersOfEveryPixel) {
  for (const double time_s : {0.0, 3.7, 100.0}) {
    const auto layers = renderSyntheticFrame(
        {.size_px = {211, 97}, .layer_count = 4, .time_s = time_s, .camera = {}});
    ASSERT_EQ(layers.size(), 4U);
    for (size_t i = 0; i < layers[0].depth_m.size(); ++i) {
      ASSERT_GT(layers[0].depth_m[i], 0.0F) << "every ray meets something, if only the sky";
      for (size_t k = 1; k < 4; ++k) {
        const float nearer = layers[k - 1].depth_m[i];
        const float depth_m = layers[k].depth_m[i];
        if (depth_m == 0) continue;
        ASSERT_GT(nearer, 0.0F) << "a layer is used only when the one before is";
        ASSERT_GT(depth_m, nearer);
      }
    }
  }
}

TEST(SyntheticFrame, showsSurfacesBetween1p5And8MetresAndTheSky) {
  const auto layers = renderSyntheticFrame({.size_px = {320, 180}, .layer_count = 1, .camera = {}});
  size_t sky_count = 0;
  for (const float depth_m : layers[0].depth_m) {
    if (std::isinf(depth_m)) {
      ++sky_count;
      continue;
    }
    ASSERT_GE(depth_m, 1.5F);
    ASSERT_LE(depth_m, 8.0F);
  }
  EXPECT_GT(sky_count, layers[0].depth_m.size() / 20);
  EXPECT_LT(sky_count, layers[0].depth_m.size() / 2);
}

TEST(SyntheticFrame, usesAllFourLayers) {
  const auto layers = renderSyntheticFrame({.size_px = {480, 270}, .layer_count = 4, .camera = {}});
  for (const SyntheticLayer& layer : layers) {
    size_t count = 0;
    for (const float depth_m : layer.depth_m) count += depth_m > 0;
    EXPECT_GT(count, layer.depth_m.size() / 1000);
  }
}

TEST(SyntheticFrame, givesTheSameLayersWhateverTheirCount) {
  const auto four = renderSyntheticFrame({.size_px = {160, 90}, .layer_count = 4, .camera = {}});
  const auto two = renderSyntheticFrame({.size_px = {160, 90}, .layer_count = 2, .camera = {}});
  for (size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(two[k].depth_m, four[k].depth_m);
    EXPECT_EQ(two[k].color, four[k].color);
  }
}

TEST(SyntheticFrame, givesTheSameBytesWhateverTheThreads) {
  SyntheticOptions options{.size_px = {161, 91}, .layer_count = 3, .time_s = 1.25, .camera = {}};
  options.thread_count = 1;
  const auto one = renderSyntheticFrame(options);
  options.thread_count = 5;
  const auto five = renderSyntheticFrame(options);
  for (size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].color, five[k].color);
    EXPECT_EQ(one[k].depth_m, five[k].depth_m);
  }
}

TEST(SyntheticFrame, moves) {
  const auto now = renderSyntheticFrame({.size_px = {64, 36}, .time_s = 0, .camera = {}});
  const auto later = renderSyntheticFrame({.size_px = {64, 36}, .time_s = 0.5, .camera = {}});
  EXPECT_NE(now[0].depth_m, later[0].depth_m);
}

// Follows a point on a ball or panel to a slightly later or earlier time.
std::optional<glm::dvec3> carriedPoint(const glm::dvec3& point_m, double time_s, double later_s) {
  const synthetic::Scene now = synthetic::makeScene(time_s);
  const synthetic::Scene then = synthetic::makeScene(time_s + later_s);
  for (size_t i = 0; i < now.spheres.size(); ++i) {
    const synthetic::Sphere& ball = now.spheres[i];
    const glm::dvec3 from_center_m = point_m - ball.center_m;
    if (std::abs(glm::length(from_center_m) - ball.radius_m) > kFloatDepthError_m) continue;
    const double turn_rad = then.spheres[i].spin_rad - ball.spin_rad;
    return then.spheres[i].center_m + glm::angleAxis(turn_rad, glm::dvec3(0, 1, 0)) * from_center_m;
  }
  const glm::dvec3 on_panel_m = point_m - now.panel.center_m;
  const bool is_panel = std::abs(glm::dot(on_panel_m, now.panel.normal)) <= kFloatDepthError_m &&
                        glm::length(on_panel_m) <= glm::length(now.panel.half_size_m);
  if (!is_panel) return std::nullopt;
  return then.panel.center_m + glm::dot(on_panel_m, now.panel.right) * then.panel.right +
         glm::dot(on_panel_m, now.panel.up) * then.panel.up;
}

TEST(SyntheticFrame, saysHowBallsAndThePanelMoveAndThatTheRestStands) {
  constexpr double kTime_s = 1.3;
  constexpr double kStep_s = 1e-3;
  constexpr double kSpeedError_mps = 2e-3;  // a binary16 between 2 and 4 is off by 1e-3
  const SyntheticOptions options{
      .size_px = {96, 54}, .layer_count = 2, .time_s = kTime_s, .camera = {}, .has_motion = true};
  const auto layers = renderSyntheticFrame(options);
  const Camera camera = syntheticCamera(options.size_px);
  int moving_count = 0;
  for (uint32_t px = 0; px < options.size_px.area(); ++px) {
    const double depth_m = double{layers[0].depth_m[px]};
    const auto half = [&](size_t i) {
      return double{glm::unpackHalf1x16(layers[0].motion[3 * px + i])};
    };
    const glm::dvec3 motion_mps(half(0), half(1), half(2));
    std::optional<glm::dvec3> later, earlier;
    if (std::isfinite(depth_m)) {
      const glm::dvec3 point_m =
          depth_m * rayOf(camera, px % options.size_px.width, px / options.size_px.width);
      later = carriedPoint(point_m, kTime_s, kStep_s);
      earlier = carriedPoint(point_m, kTime_s, -kStep_s);
    }
    const glm::dvec3 expected_mps = later ? (*later - *earlier) / (2 * kStep_s) : glm::dvec3(0.0);
    EXPECT_LT(glm::length(motion_mps - expected_mps), kSpeedError_mps) << px;
    moving_count += motion_mps != glm::dvec3(0) ? 1 : 0;
  }
  EXPECT_GT(moving_count, 300);
  EXPECT_TRUE(renderSyntheticFrame({.size_px = {8, 8}, .camera = {}})[0].motion.empty());
}

TEST(SyntheticFrame, meetsTheGroundWhereAPlaneThroughTheEyeRayDoes) {
  const SizePx size_px{200, 120};
  Camera camera = syntheticCamera(size_px);
  camera.pose.position_m = {0.3, 0.25, 0.4};
  camera.pose.orientation = glm::angleAxis(0.2, glm::normalize(glm::dvec3(1.0, 0.4, 0.2)));
  const auto layers =
      renderSyntheticFrame({.size_px = size_px, .layer_count = 4, .time_s = 2, .camera = camera});
  size_t met = 0;
  for (uint32_t y = 0; y < size_px.height; ++y) {
    for (uint32_t x = 0; x < size_px.width; ++x) {
      const glm::dvec3 direction = rayOf(camera, x, y);
      // eye.y + t d.y = g + s (eye.z + t d.z)
      const glm::dvec3 eye = camera.pose.position_m;
      const double t =
          (kGroundY_m + kGroundSlope * eye.z - eye.y) / (direction.y - kGroundSlope * direction.z);
      if (t <= 0 || eye.z + t * direction.z < -8.0) continue;
      const size_t i = size_t{y} * size_px.width + x;
      for (const SyntheticLayer& layer : layers) {
        ASSERT_LE(layer.depth_m[i], t + kFloatDepthError_m) << "nothing is seen through the ground";
        if (std::abs(layer.depth_m[i] - t) <= kFloatDepthError_m) ++met;
      }
    }
  }
  EXPECT_GT(met, size_px.area() / 20);
}

// Share of a's surface points that b, looked at from its own camera, has at the same place.
double shareFoundAgain(const SizePx size_px, const Camera& from, const Camera& to, double time_s) {
  const auto a = renderSyntheticFrame(
      {.size_px = size_px, .layer_count = 1, .time_s = time_s, .camera = from});
  size_t seen = 0, found = 0;
  for (uint32_t y = 0; y < size_px.height; y += 3) {
    for (uint32_t x = 0; x < size_px.width; x += 3) {
      const float depth_m = a[0].depth_m[size_t{y} * size_px.width + x];
      if (std::isinf(depth_m)) continue;
      const glm::dvec3 point_m =
          from.pose.position_m + static_cast<double>(depth_m) * rayOf(from, x, y);
      const glm::dvec3 in_to = glm::conjugate(to.pose.orientation) * (point_m - to.pose.position_m);
      // A one-pixel camera whose only ray goes through the point.
      Camera probe = to;
      const double focal_px = to.intrinsics.focal_px.x;
      probe.intrinsics.principal_px = {0.5 + focal_px * in_to.x / in_to.z,
                                       0.5 - focal_px * in_to.y / in_to.z};
      const auto b = renderSyntheticFrame({.size_px = {1, 1},
                                           .layer_count = 4,
                                           .time_s = time_s,
                                           .camera = probe,
                                           .thread_count = 1});
      ++seen;
      bool here = false;
      // The point itself is only as exact as its binary32 depth, seen along a grazing ground.
      constexpr double kPointError_m = 1e-4;
      for (const SyntheticLayer& layer : b) {
        here = here || std::abs(layer.depth_m[0] + in_to.z) < kPointError_m;
      }
      found += here;
    }
  }
  EXPECT_GT(seen, 500U);
  return static_cast<double>(found) / static_cast<double>(seen);
}

TEST(SyntheticFrame, findsEveryPointAgainFromAnotherCamera) {
  const SizePx size_px{150, 90};
  const Camera from = syntheticCamera(size_px);
  Camera to = from;
  to.pose.position_m = {0.06, 0.03, -0.02};
  to.pose.orientation = glm::angleAxis(0.05, glm::dvec3(0.0, 1.0, 0.0));
  // Surfaces that face away from the other camera may be missing: edges of balls and poles. The
  // ground and the ridges, most of the picture, face both cameras.
  EXPECT_GT(shareFoundAgain(size_px, from, to, 1.5), 0.99);
}

TEST(SyntheticFrame, coloursAPointTheSameFromEverySide) {
  const SizePx size_px{192, 108};
  const Camera from = syntheticCamera(size_px);
  const auto a = renderSyntheticFrame({.size_px = size_px, .time_s = 1, .camera = from});
  Camera to = from;
  to.pose.position_m = {0.02, 0.0, 0.0};
  size_t same = 0, seen = 0;
  for (uint32_t y = 0; y < size_px.height; y += 2) {
    for (uint32_t x = 0; x < size_px.width; x += 2) {
      const size_t i = size_t{y} * size_px.width + x;
      const double depth_m = a[0].depth_m[i];
      if (std::isinf(depth_m)) continue;
      Camera probe = to;
      const glm::dvec3 point_m = depth_m * rayOf(from, x, y) - to.pose.position_m;
      const double focal_px = to.intrinsics.focal_px.x;
      probe.intrinsics.principal_px = {0.5 + focal_px * point_m.x / point_m.z,
                                       0.5 - focal_px * point_m.y / point_m.z};
      const auto b = renderSyntheticFrame(
          {.size_px = {1, 1}, .time_s = 1, .camera = probe, .thread_count = 1});
      if (std::abs(b[0].depth_m[0] - depth_m) > 1e-4) continue;
      ++seen;
      int difference = 0;
      for (size_t c = 0; c < 3; ++c) {
        difference = std::max(difference, std::abs(a[0].color[4 * i + c] - b[0].color[c]));
      }
      same += difference <= 2;
    }
  }
  EXPECT_GT(seen, 2000U);
  EXPECT_GT(static_cast<double>(same), 0.99 * static_cast<double>(seen));
}

}  // namespace
}  // namespace viewloom::synthetic_frame_test
