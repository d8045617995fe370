// SPDX-License-Identifier: Apache-2.0
#include "synthetic/surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/vec2.hpp>

#include "synthetic/edges.h"
#include "synthetic/portrait_textures.h"

namespace viewloom::synthetic {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr vec3 kSunLight{1.05F, 0.95F, 0.80F};
constexpr vec3 kSkyLight{0.24F, 0.30F, 0.42F};
constexpr vec3 kGroundLight{0.16F, 0.13F, 0.10F};
constexpr vec3 kHorizon{0.72F, 0.78F, 0.90F};
constexpr vec3 kZenith{0.12F, 0.30F, 0.72F};

vec3 groundTexture(vec2 xz, float edge_m) {
  constexpr float kTile_m = 0.4F;
  const vec2 tile = xz / kTile_m;
  const vec3 light{0.62F, 0.50F, 0.36F};
  const vec3 dark{0.30F, 0.20F, 0.15F};
  const float grain = 0.10F * std::sin(9.0F * xz.x + 5.0F * xz.y);
  return glm::mix(dark, light, checker(tile, edge_m / kTile_m)) * (1.0F + grain);
}

vec3 ridgeTexture(const Ridge& ridge, vec2 xy, float edge_m) {
  const float contour_m = 0.16F * static_cast<float>(ridge.scale);
  const float drift = 0.10F * std::sin(3.0F * xy.x) + 0.06F * std::sin(7.0F * xy.x + 1.0F);
  const float contour = squareWave((xy.y + drift) / contour_m, edge_m / contour_m);
  return ridge.color * (0.70F + 0.40F * contour);
}

vec3 panelTexture(vec2 uv_m, vec2 half_size_m, float edge_m) {
  constexpr float kSquare_m = 0.1F;
  constexpr float kFrame_m = 0.05F;
  const vec2 inside = half_size_m - glm::abs(uv_m);
  if (std::min(inside.x, inside.y) < kFrame_m) return {0.55F, 0.40F, 0.10F};
  const vec3 warm = glm::mix(vec3(0.85F, 0.15F, 0.25F), vec3(0.95F, 0.70F, 0.10F),
                             0.5F + 0.5F * uv_m.x / half_size_m.x);
  return glm::mix(vec3(0.92F), warm, checker(uv_m / kSquare_m, edge_m / kSquare_m));
}

vec3 sphereTexture(const Sphere& sphere, const vec3& normal, float edge_m) {
  constexpr float kStripes = 6.0F;  // pairs of stripes around the ball
  const float radius =
      std::max(std::hypot(normal.x, normal.z), 1e-3F);  // of the circle of latitude
  const float angle = std::atan2(normal.z, normal.x) + static_cast<float>(sphere.spin_rad);
  const float edge = edge_m / static_cast<float>(sphere.radius_m) / radius * kStripes / kPi;
  const float stripe = squareWave(angle * kStripes / kPi, std::min(edge, 0.5F));
  return glm::mix(sphere.color, sphere.stripe_color, stripe);
}

vec3 skyColor(const glm::dvec3& direction, const glm::dvec3& to_sun, double time_s) {
  const vec3 ray(glm::normalize(direction));
  const float height = std::clamp(2.2F * ray.y, 0.0F, 1.0F);
  const float drift = static_cast<float>(0.03 * time_s);
  const float waves = std::sin(9.0F * ray.x + drift + 8.0F * ray.y) +
                      std::sin(17.0F * ray.x - 2.0F * drift - 21.0F * ray.y);
  const float cloud = std::clamp(0.30F * waves - 0.05F, 0.0F, 0.5F);
  const float glow = std::max(0.0F, glm::dot(ray, vec3(to_sun)));
  return glm::mix(glm::mix(kHorizon, kZenith, height), vec3(0.95F), cloud) +
         vec3(0.25F, 0.18F, 0.08F) * glow * glow * glow;
}

struct Material {
  vec3 color;
  vec3 normal;
};

Material materialAt(const Scene& scene, const Hit& hit, const glm::dvec3& point_m,
                    const glm::dvec3& direction, float edge_m) {
  switch (hit.kind) {
    case SurfaceKind::kSphere: {
      const Sphere& sphere = scene.spheres[hit.index];
      const vec3 normal((point_m - sphere.center_m) / sphere.radius_m);
      return {sphereTexture(sphere, normal, edge_m), normal};
    }
    case SurfaceKind::kPole: {
      const Pole& pole = scene.poles[hit.index];
      return {vec3(0.20F, 0.22F, 0.26F), vec3((point_m.x - pole.center_xz_m.x) / pole.radius_m, 0.0,
                                              (point_m.z - pole.center_xz_m.y) / pole.radius_m)};
    }
    case SurfaceKind::kPanel: {
      const Panel& panel = scene.panel;
      const glm::dvec3 offset = point_m - panel.center_m;
      const vec2 uv_m(glm::dot(offset, panel.right), glm::dot(offset, panel.up));
      const double side = glm::dot(direction, panel.normal) < 0 ? 1.0 : -1.0;
      const auto& texture = scene.setting == Setting::kPortrait ? boardTexture : panelTexture;
      return {texture(uv_m, vec2(panel.half_size_m), edge_m), vec3(side * panel.normal)};
    }
    case SurfaceKind::kRidge:
      return {ridgeTexture(scene.ridges[hit.index], vec2(point_m.x, point_m.y), edge_m),
              vec3(0.0F, 0.0F, 1.0F)};
    case SurfaceKind::kRod: {
      const Rod& rod = scene.rods[hit.index];
      const glm::dvec3 axis = glm::normalize(rod.end_m - rod.start_m);
      const glm::dvec3 offset = point_m - rod.start_m;
      return {rod.color, vec3((offset - glm::dot(offset, axis) * axis) / rod.radius_m)};
    }
    case SurfaceKind::kBackdrop: {
      // Lit as the ridge that it continues, which faces +z.
      const PaintedRidge painted = paintedRidge(scene, point_m);
      const vec3 color = painted.ridge == nullptr
                             ? vec3(0.0F)
                             : ridgeTexture(*painted.ridge, vec2(painted.xy_m), edge_m);
      return {color, vec3(0.0F, 0.0F, 1.0F)};
    }
    default:
      const auto& texture =
          scene.setting == Setting::kPortrait ? pavedGroundTexture : groundTexture;
      return {texture(vec2(point_m.x, point_m.z), edge_m),
              vec3(glm::normalize(glm::dvec3(0.0, 1.0, -kGroundSlope)))};
  }
}

}  // namespace

vec3 surfaceColor(const Scene& scene, const SunShadows& shadows, const Hit& hit,
                  const glm::dvec3& point_m, const glm::dvec3& direction, float edge_m) {
  if (hit.kind == SurfaceKind::kSky) return skyColor(direction, scene.to_sun, scene.time_s);
  const bool is_painted = hit.kind == SurfaceKind::kBackdrop;
  if (is_painted && paintedRidge(scene, point_m).ridge == nullptr) {
    return paintedSky(scene, point_m);
  }
  const Material material = materialAt(scene, hit, point_m, direction, edge_m);
  const float facing = std::max(0.0F, glm::dot(material.normal, vec3(scene.to_sun)));
  const float sun = is_painted   ? facing
                    : facing > 0 ? facing * shadows.sunShare(hit, vec3(point_m))
                                 : 0.0F;
  const vec3 ambient = glm::mix(kGroundLight, kSkyLight, 0.5F + 0.5F * material.normal.y);
  // Haze by distance in the world, not from the eye: a point looks the same in every view.
  const float haze = std::clamp(static_cast<float>(-point_m.z - 3.0) * 0.04F, 0.0F, 0.18F);
  return glm::mix(material.color * (ambient + kSunLight * sun), kHorizon, haze);
}

vec3 surfaceNormal(const Scene& scene, const Hit& hit, const glm::dvec3& point_m,
                   const glm::dvec3& direction) {
  return materialAt(scene, hit, point_m, direction, 1.0F).normal;
}

namespace {

Gloss glossOfFinish(Finish finish) {
  switch (finish) {
    case Finish::kLake:
      return {.light = {0.30F, 0.34F, 0.38F}, .roughness = 0, .own_share = 0.35F};
    case Finish::kPolished:
      return {.light = {0.30F, 0.30F, 0.30F}, .roughness = 0, .own_share = 0.70F};
    case Finish::kPearl:
      return {.light = {0.42F, 0.42F, 0.42F}, .roughness = 0, .own_share = 0.60F};
    case Finish::kMetal:
      return {.light = {0.85F, 0.87F, 0.90F}, .roughness = 0, .own_share = 0.08F};
    case Finish::kChrome:
      return {.light = {0.80F, 0.80F, 0.82F}, .roughness = 0, .own_share = 0.12F};
    case Finish::kCopper:  // brushed
      return {.light = {0.75F, 0.45F, 0.30F}, .roughness = 0.4F, .own_share = 0.3F};
    default:
      return {};
  }
}

}  // namespace

Gloss glossOf(const Scene& scene, const Hit& hit) {
  switch (hit.kind) {
    case SurfaceKind::kGround:
      return glossOfFinish(scene.ground_finish);
    case SurfaceKind::kPanel:
      return glossOfFinish(scene.panel_finish);
    case SurfaceKind::kSphere:
      return glossOfFinish(scene.spheres[hit.index].finish);
    default:
      return {};
  }
}

uint32_t octahedron(const glm::vec3& normal) {
  const glm::vec3 size = glm::abs(normal);
  const glm::vec3 on = normal / (size.x + size.y + size.z);
  const auto folded = [](float value, float other) {
    return std::copysign(1.0F - std::abs(other), value);
  };
  const glm::vec2 uv =
      on.z >= 0 ? glm::vec2(on) : glm::vec2(folded(on.x, on.y), folded(on.y, on.x));
  const auto code = [](float value) {
    return static_cast<uint32_t>(std::lround((std::clamp(value, -1.0F, 1.0F) + 1.0F) * 32767.5F));
  };
  return code(uv.x) | code(uv.y) << 16;
}

namespace {

// Motion of a body that turns around the upright through its centre.
glm::dvec3 motionAt(const glm::dvec3& velocity_mps, double turn_rad_per_s,
                    const glm::dvec3& from_center_m) {
  return velocity_mps + glm::cross(glm::dvec3(0, turn_rad_per_s, 0), from_center_m);
}

}  // namespace

glm::dvec3 surfaceMotion(const Scene& scene, const Hit& hit, const glm::dvec3& point_m) {
  if (hit.kind == SurfaceKind::kSphere) {
    const Sphere& ball = scene.spheres[hit.index];
    return motionAt(ball.velocity_mps, ball.spin_rad_per_s, point_m - ball.center_m);
  }
  if (hit.kind == SurfaceKind::kPanel) {
    const Panel& panel = scene.panel;
    return motionAt(panel.velocity_mps, panel.turn_rad_per_s, point_m - panel.center_m);
  }
  if (hit.kind == SurfaceKind::kRod) {
    const Rod& rod = scene.rods[hit.index];
    return motionAt(rod.velocity_mps, rod.turn_rad_per_s, point_m - rod.pivot_m);
  }
  return glm::dvec3(0.0);
}

std::array<uint16_t, 3> halvesOf(const glm::dvec3& vector) {
  return {glm::packHalf1x16(float(vector.x)), glm::packHalf1x16(float(vector.y)),
          glm::packHalf1x16(float(vector.z))};
}

}  // namespace viewloom::synthetic
