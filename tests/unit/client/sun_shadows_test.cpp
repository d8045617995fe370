// SPDX-License-Identifier: Apache-2.0
// The sun's share at random points, against every ball, pole and panel looked at for itself.
#include "synthetic/sun_shadows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>

namespace viewloom::synthetic::sun_shadows_test {
namespace {

// Penumbras are 4 cm wide or wider, and binary32 places a point within 1e-5 m; smoothstep rises by
// at most 1.5 over its width.
constexpr double kShareError = 1e-3;

// A penumbra of a quarter of half the thing's width on both sides of its edge, at least 2 cm.
double passing(double distance_m, double size_m) {
  const double blur_m = std::max(0.25 * size_m, 0.02);
  const double x = std::clamp((distance_m - size_m + blur_m) / (2 * blur_m), 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

double shareFromEachOf(const Scene& scene, const Hit& hit, const glm::dvec3& point_m) {
  const glm::dvec3& sun = scene.to_sun;
  double share = 1;
  for (size_t i = 0; i < scene.spheres.size(); ++i) {
    const glm::dvec3 offset = scene.spheres[i].center_m - point_m;
    const bool is_itself = hit.kind == SurfaceKind::kSphere && hit.index == i;
    if (is_itself || glm::dot(offset, sun) <= 0) continue;
    share *= passing(glm::length(glm::cross(offset, sun)), scene.spheres[i].radius_m);
  }
  const glm::dvec2 flat_sun{sun.x, sun.z};
  for (const Pole& pole : scene.poles) {
    const glm::dvec2 offset = pole.center_xz_m - glm::dvec2(point_m.x, point_m.z);
    const double along = glm::dot(offset, flat_sun) / glm::dot(flat_sun, flat_sun);
    if (along <= 0 || point_m.y + along * sun.y > pole.top_y_m) continue;
    const glm::dvec2 across = offset - along * flat_sun;
    share *= passing(glm::length(across), pole.radius_m);
  }
  const Panel& panel = scene.panel;
  const glm::dvec3 offset = panel.center_m - point_m;
  const double along_m = glm::dot(offset, panel.normal) / glm::dot(sun, panel.normal);
  if (along_m > 0) {
    const glm::dvec3 on_panel = along_m * sun - offset;
    share *= std::max(passing(std::abs(glm::dot(on_panel, panel.right)), panel.half_size_m.x),
                      passing(std::abs(glm::dot(on_panel, panel.up)), panel.half_size_m.y));
  }
  return share;
}

TEST(SunShadows, areThoseOfEveryThingLookedAtForItself) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> x_m(-3, 3), z_m(-8, -1.5);
  size_t shaded_count = 0;
  constexpr int kPointCount = 20000;
  for (const double time_s : {0.0, 2.5, 40.0}) {
    const Scene scene = makeScene(time_s);
    const SunShadows shadows(scene);
    for (int i = 0; i < kPointCount; ++i) {
      glm::dvec3 point_m{x_m(random), 0.0, z_m(random)};
      point_m.y = kGroundY_m + kGroundSlope * point_m.z;
      const Hit hit{-point_m.z, SurfaceKind::kGround, 0};
      const double expected = shareFromEachOf(scene, hit, point_m);
      ASSERT_NEAR(shadows.sunShare(hit, glm::vec3(point_m)), expected, kShareError)
          << "at " << point_m.x << ", " << point_m.z << ", " << time_s << " s";
      shaded_count += expected < 1;
    }
  }
  EXPECT_GT(shaded_count, kPointCount / 10U);
}

}  // namespace
}  // namespace viewloom::synthetic::sun_shadows_test
