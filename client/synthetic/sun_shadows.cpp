// SPDX-License-Identifier: Apache-2.0
#include "synthetic/sun_shadows.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "base/check.h"

namespace viewloom::synthetic {
namespace {

using glm::vec2;
using glm::vec3;

// Slack of the test of all at once, so that every refused point is lit: coordinates below 16 m,
// squared, round by less than 16^2 2^-23 = 3e-5 m^2 an operation.
constexpr float kSlack_m2 = 1e-3F;
constexpr float kSlack_m = 1e-3F;

// How much of the sun a thing of half width size_m lets by when the ray to the sun passes its
// middle line at distance_m: a penumbra of a quarter of its size, at least 2 cm.
float passing(float distance_m, float size_m) {
  const float blur_m = std::max(0.25F * size_m, 0.02F);
  return glm::smoothstep(size_m - blur_m, size_m + blur_m, distance_m);
}

// Beyond it nothing is shaded.
float reachOf(float size_m) {
  return 1.25F * size_m + 0.02F;
}

float sphereShade(const Sphere& sphere, const vec3& point_m, const vec3& to_sun) {
  const vec3 to_center = vec3(sphere.center_m) - point_m;
  const float along_m = glm::dot(to_center, to_sun);
  if (along_m <= 0) return 1;
  const float square_m2 = glm::dot(to_center, to_center) - along_m * along_m;
  const float radius_m = static_cast<float>(sphere.radius_m);
  const float reach_m = reachOf(radius_m);
  if (square_m2 > reach_m * reach_m) return 1;
  return passing(std::sqrt(std::max(square_m2, 0.0F)), radius_m);
}

float poleShade(const Pole& pole, const vec3& point_m, const vec3& to_sun) {
  const vec2 to_pole = vec2(pole.center_xz_m) - vec2(point_m.x, point_m.z);
  const vec2 flat_sun{to_sun.x, to_sun.z};
  const float square = glm::dot(flat_sun, flat_sun);
  const float along = glm::dot(to_pole, flat_sun) / square;
  if (along <= 0 || point_m.y + along * to_sun.y > static_cast<float>(pole.top_y_m)) return 1;
  const float cross = to_pole.x * flat_sun.y - to_pole.y * flat_sun.x;
  return passing(std::abs(cross) / std::sqrt(square), static_cast<float>(pole.radius_m));
}

float panelShade(const Panel& panel, const vec3& point_m, const vec3& to_sun) {
  const vec3 to_center = vec3(panel.center_m) - point_m;
  const vec3 normal(panel.normal);
  const float along_m = glm::dot(to_center, normal) / glm::dot(to_sun, normal);
  if (!(along_m > 0)) return 1;
  const vec3 on_panel = along_m * to_sun - to_center;
  const vec2 half_size_m(panel.half_size_m);
  return std::max(passing(std::abs(glm::dot(on_panel, vec3(panel.right))), half_size_m.x),
                  passing(std::abs(glm::dot(on_panel, vec3(panel.up))), half_size_m.y));
}

}  // namespace

SunShadows::SunShadows(const Scene& scene)
    : scene_(scene),
      to_sun_(scene.to_sun),
      flat_sun_length_(glm::length(vec2(to_sun_.x, to_sun_.z))) {
  VIEWLOOM_CHECK(scene.spheres.size() <= kSphereCountMax && scene.poles.size() <= kPoleCountMax);
  spheres_ = {};
  spheres_.reach_m2.fill(-kSlack_m2);
  for (size_t i = 0; i < scene.spheres.size(); ++i) {
    const vec3 center_m(scene.spheres[i].center_m);
    const float reach_m = reachOf(static_cast<float>(scene.spheres[i].radius_m));
    spheres_.x_m[i] = center_m.x;
    spheres_.y_m[i] = center_m.y;
    spheres_.z_m[i] = center_m.z;
    spheres_.reach_m2[i] = reach_m * reach_m + kSlack_m2;
  }
  poles_ = {};
  poles_.reach_m.fill(-1);
  for (size_t i = 0; i < scene.poles.size(); ++i) {
    poles_.x_m[i] = static_cast<float>(scene.poles[i].center_xz_m.x);
    poles_.z_m[i] = static_cast<float>(scene.poles[i].center_xz_m.y);
    poles_.reach_m[i] =
        (reachOf(static_cast<float>(scene.poles[i].radius_m)) + kSlack_m) * flat_sun_length_;
  }
}

bool SunShadows::mayBeInASpheresShadow(const vec3& point_m) const {
  int count = 0;
  for (size_t i = 0; i < kSphereCountMax; ++i) {
    const float x_m = spheres_.x_m[i] - point_m.x;
    const float y_m = spheres_.y_m[i] - point_m.y;
    const float z_m = spheres_.z_m[i] - point_m.z;
    const float along_m = x_m * to_sun_.x + y_m * to_sun_.y + z_m * to_sun_.z;
    const float square_m2 = x_m * x_m + y_m * y_m + z_m * z_m - along_m * along_m;
    count += int{along_m > -kSlack_m} & int{square_m2 <= spheres_.reach_m2[i]};
  }
  return count > 0;
}

bool SunShadows::mayBeInAPolesShadow(const vec3& point_m) const {
  int count = 0;
  for (size_t i = 0; i < kPoleCountMax; ++i) {
    const float x_m = poles_.x_m[i] - point_m.x;
    const float z_m = poles_.z_m[i] - point_m.z;
    const float across_m = x_m * to_sun_.z - z_m * to_sun_.x;  // times flat_sun_length_
    count += int{std::abs(across_m) <= poles_.reach_m[i]};
  }
  return count > 0;
}

float SunShadows::sunShare(const Hit& hit, const vec3& point_m) const {
  float share = 1;
  if (mayBeInASpheresShadow(point_m)) {
    for (size_t i = 0; i < scene_.spheres.size(); ++i) {
      if (hit.kind == SurfaceKind::kSphere && hit.index == i) continue;
      share *= sphereShade(scene_.spheres[i], point_m, to_sun_);
    }
  }
  const bool is_by_poles = hit.kind == SurfaceKind::kGround || hit.kind == SurfaceKind::kSphere;
  if (is_by_poles && mayBeInAPolesShadow(point_m)) {
    for (const Pole& pole : scene_.poles) share *= poleShade(pole, point_m, to_sun_);
  }
  if (hit.kind != SurfaceKind::kPanel) share *= panelShade(scene_.panel, point_m, to_sun_);
  return share;
}

}  // namespace viewloom::synthetic
