// SPDX-License-Identifier: Apache-2.0
// The built-in scenes of the client and this caster, each written without the other, meet the same
// surfaces.
#include <cmath>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "support/truth/picture.h"
#include "synthetic/cast_row.h"
#include "synthetic/portrait_scene.h"

namespace viewloom::truth::built_in_scene_test {
namespace {

using synthetic::SurfaceKind;

constexpr SizePx kSize_px{128, 72};

// The bodies of one kind begin at its index, in the order of the built-in scene.
struct SameScene {
  Scene scene;
  uint32_t first_pole = 0;
  uint32_t panel = 0;
  uint32_t first_rod = 0;
};

SameScene bodiesOf(const synthetic::Scene& from) {
  SameScene same;
  for (const synthetic::Sphere& sphere : from.spheres) {
    same.scene.add({.shape = Sphere{sphere.radius_m}, .pose = {.position_m = sphere.center_m}});
  }
  same.first_pole = uint32_t(same.scene.bodies.size());
  for (const synthetic::Pole& pole : from.poles) {
    constexpr double kHalf_m = 5;  // reaches far below the ground
    const glm::dvec3 center_m(pole.center_xz_m.x, pole.top_y_m - kHalf_m, pole.center_xz_m.y);
    same.scene.add({.shape = Cylinder{pole.radius_m, kHalf_m}, .pose = {.position_m = center_m}});
  }
  same.panel = uint32_t(same.scene.bodies.size());
  const synthetic::Panel& panel = from.panel;
  const glm::dquat turned = glm::quat_cast(glm::dmat3(panel.right, panel.up, panel.normal));
  same.scene.add({.shape = Box{{panel.half_size_m, 0}}, .pose = {panel.center_m, turned}});
  same.first_rod = uint32_t(same.scene.bodies.size());
  for (const synthetic::Rod& rod : from.rods) {
    const glm::dvec3 along_m = rod.end_m - rod.start_m;
    const glm::dvec3 up = glm::normalize(along_m);
    const glm::dvec3 side = glm::normalize(glm::cross(up, glm::dvec3(0.6, 0.5, 0.7)));
    const glm::dquat upright = glm::quat_cast(glm::dmat3(side, up, glm::cross(side, up)));
    same.scene.add({.shape = Cylinder{rod.radius_m, 0.5 * glm::length(along_m)},
                    .pose = {0.5 * (rod.start_m + rod.end_m), upright}});
  }
  return same;
}

void expectTheSameSurfaces(const synthetic::Scene& built_in) {
  const SameScene same = bodiesOf(built_in);
  const Instant instant(same.scene, 0);
  const Camera camera{.pose = {.position_m = {0.1, 0.05, -0.2},
                               .orientation = glm::dquat(glm::dvec3(0.02, -0.05, 0.1))},
                      .intrinsics = {{110, 110}, {60, 40}}};
  const glm::dvec3 step =
      rayThrough(camera, {1, 0}).direction - rayThrough(camera, {0, 0}).direction;
  std::vector<synthetic::HitColumn> row(kSize_px.width);
  int compared_count = 0;
  for (uint32_t y = 0; y < kSize_px.height; ++y) {
    const Ray first = rayThrough(camera, {0.5, y + 0.5});
    synthetic::castRow(built_in, {first.origin_m, first.direction, step}, synthetic::kMaxLayers,
                       row);
    for (uint32_t x = 0; x < kSize_px.width; ++x) {
      const HitColumn column = instant.peel(rayThrough(camera, {x + 0.5, y + 0.5}), kLayersMax);
      for (uint32_t i = 0; i < row[x].count; ++i) {
        const synthetic::Hit& hit = row[x].hits[i];
        const uint32_t body = hit.kind == SurfaceKind::kSphere  ? hit.index
                              : hit.kind == SurfaceKind::kPole  ? same.first_pole + hit.index
                              : hit.kind == SurfaceKind::kPanel ? same.panel
                              : hit.kind == SurfaceKind::kRod   ? same.first_rod + hit.index
                                                                : kNoBody;
        if (body == kNoBody) continue;
        const Hit* const met = column.find(body);
        ASSERT_NE(met, nullptr) << x << " " << y;
        EXPECT_NEAR(met->depth, hit.depth_m, 1e-9) << x << " " << y;  // roundings at limbs, m
        ++compared_count;
      }
    }
  }
  EXPECT_GT(compared_count, 1000);
}

TEST(TruthAndBuiltInScene, meetTheSameSurfacesAtTheSameDepths) {
  expectTheSameSurfaces(synthetic::makeScene(1.7));
}

TEST(TruthAndBuiltInScene, meetTheSameSurfacesOfThePortraitScene) {
  expectTheSameSurfaces(synthetic::makePortraitScene(4.7));
}

}  // namespace
}  // namespace viewloom::truth::built_in_scene_test
