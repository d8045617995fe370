// SPDX-License-Identifier: Apache-2.0
#include "support/truth/mirror_scenes.h"

namespace viewloom::truth {
namespace {

using glm::dvec3;

constexpr dvec3 kLow_m(-1.8, -0.9, -4.5);
constexpr dvec3 kHigh_m(1.8, 1.3, 1.0);
constexpr double kMirrorsAt_m = 1.3;  // to both sides, where they face each other
constexpr double kOverlap_m = 1e-6;   // of sheets that meet, so that no ray slips through

Body painted(const Shape& shape, const dvec3& at_m, const glm::vec3& light, double wave_m = 0.2) {
  return {shape, {at_m, {1, 0, 0, 0}}, {light, 0.35F * light, wave_m}};
}

Body sheet(glm::length_t axis, double place_m, const glm::vec3& light, const Gloss& gloss) {
  dvec3 at_m = 0.5 * (kLow_m + kHigh_m);
  dvec3 half_m = 0.5 * (kHigh_m - kLow_m) + kOverlap_m;
  at_m[axis] = place_m;
  half_m[axis] = 0;
  // Mirrors show little of their own colour.
  const float own = gloss.mirrors() ? 0.25F : 1.0F;
  Body body = painted(Box{half_m}, at_m, own * light, 0.4);
  body.gloss = gloss;
  return body;
}

Scene roomWith(const Gloss& floor) {
  Scene scene;
  scene.add(sheet(0, kLow_m.x, {0.80F, 0.45F, 0.40F}, {}));
  scene.add(sheet(0, kHigh_m.x, {0.40F, 0.55F, 0.80F}, {}));
  scene.add(sheet(1, kLow_m.y, {0.60F, 0.60F, 0.62F}, floor));
  scene.add(sheet(1, kHigh_m.y, {0.85F, 0.85F, 0.80F}, {}));
  scene.add(sheet(2, kLow_m.z, {0.75F, 0.70F, 0.45F}, {}));
  scene.add(sheet(2, kHigh_m.z, {0.30F, 0.50F, 0.35F}, {}));
  scene.add(painted(Sphere{0.32}, {-0.75, -0.58, -3.2}, {0.90F, 0.35F, 0.25F}));
  scene.add(painted(Box{{0.25, 0.25, 0.25}}, {0.9, -0.65, -3.7}, {0.35F, 0.75F, 0.40F}));
  scene.add(painted(Cylinder{0.12, 1.1}, {0.1, 0.2, -4.0}, {0.70F, 0.60F, 0.85F}));
  scene.add(painted(Sphere{0.2}, {1.2, 0.5, -3.6}, {0.95F, 0.80F, 0.30F}));
  return scene;
}

}  // namespace

Scene mirrorFloor(double roughness) {
  return roomWith({.light = glm::vec3(0.6F), .roughness = static_cast<float>(roughness)});
}

Scene mirrorSphere() {
  Scene scene = roomWith({});
  Body& ball = scene.add(painted(Sphere{0.5}, {0.1, -0.4, -2.6}, {0.15F, 0.15F, 0.15F}));
  ball.gloss.light = {0.75F, 0.7F, 0.6F};
  return scene;
}

Scene facingMirrors() {
  Scene scene = roomWith({});
  for (const double side : {-1.0, 1.0}) {
    scene.add(sheet(0, side * kMirrorsAt_m, {0.60F, 0.60F, 0.62F}, {.light = glm::vec3(0.7F)}));
  }
  return scene;
}

}  // namespace viewloom::truth
