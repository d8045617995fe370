// SPDX-License-Identifier: Apache-2.0
#include "support/truth/scenes.h"

#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>

namespace viewloom::truth {
namespace {

using glm::dvec3;

constexpr double kHalfTurn = std::numbers::pi;

// Length of a wave seen frontally from the origin: 25 px of a picture with a focal length of 560
// px.
constexpr double kWave_rad = 0.045;

constexpr double kTableTop_m = -0.425;

Paint paint(const glm::vec3& light, double distance_m) {
  return {light, 0.35F * light, kWave_rad * distance_m};
}

// A colour for the i-th of many things.
glm::vec3 tint(uint32_t i) {
  const auto share = [&](double stride) {
    const double x = stride * (i + 1);
    return static_cast<float>(0.35 + 0.6 * (x - std::floor(x)));
  };
  return {share(0.618), share(0.755), share(0.570)};
}

Body still(const Shape& shape, const dvec3& at_m, const glm::vec3& light,
           const glm::dquat& turn = {1, 0, 0, 0}) {
  return {shape, {at_m, turn}, paint(light, glm::length(at_m))};
}

glm::dquat turned(double angle_rad, const dvec3& axis) {
  return glm::angleAxis(angle_rad, glm::normalize(axis));
}

// Sheets of this size meet at the edges, and overlap there so that no ray slips through.
void addRoom(const dvec3& low_m, const dvec3& high_m, Scene& scene) {
  constexpr double kOverlap_m = 1e-6;
  const dvec3 center_m = 0.5 * (low_m + high_m);
  const dvec3 half_m = 0.5 * (high_m - low_m);
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      dvec3 at_m = center_m;
      at_m[axis] += side * half_m[axis];
      dvec3 sheet_half_m = half_m + kOverlap_m;
      sheet_half_m[axis] = 0;
      const auto hue = static_cast<uint32_t>(2 * axis + (side > 0 ? 1 : 0));
      Body wall = still(Box{sheet_half_m}, at_m, tint(20 + hue));
      wall.paint.wave_m = kWave_rad * 5;
      scene.add(wall);
    }
  }
}

void addLegs(const dvec3& top_m, const dvec3& half_m, double foot_m, double radius_m,
             Scene& scene) {
  const double half_length_m = 0.5 * (top_m.y - foot_m);
  for (const double x : {-1.0, 1.0}) {
    for (const double z : {-1.0, 1.0}) {
      scene.add(still(Cylinder{radius_m, half_length_m},
                      {top_m.x + x * half_m.x, foot_m + half_length_m, top_m.z + z * half_m.z},
                      {0.60F, 0.42F, 0.25F}));
    }
  }
}

void addTableAndChair(double floor_m, Scene& scene) {
  constexpr double kBoardHalf_m = 0.025;
  const dvec3 table_m(-0.35, kTableTop_m - kBoardHalf_m, -2.7);
  scene.add(still(Box{{0.70, kBoardHalf_m, 0.40}}, table_m, {0.80F, 0.60F, 0.36F}));
  addLegs(table_m, {0.64, 0, 0.34}, floor_m, 0.030, scene);
  const dvec3 seat_m(0.95, -0.62, -2.5);
  scene.add(still(Box{{0.22, 0.02, 0.22}}, seat_m, {0.75F, 0.30F, 0.28F}));
  addLegs(seat_m, {0.19, 0, 0.19}, floor_m, 0.018, scene);
  for (const double height_m : {0.25, 0.40, 0.55}) {
    scene.add(
        still(Box{{0.22, 0.03, 0.01}}, seat_m + dvec3(0, height_m, -0.2), {0.75F, 0.30F, 0.28F}));
  }
  for (const double x_m : {-0.2, 0.2}) {
    scene.add(
        still(Cylinder{0.015, 0.31}, seat_m + dvec3(x_m, 0.3, -0.215), {0.55F, 0.25F, 0.22F}));
  }
}

void addShelves(double back_m, Scene& scene) {
  uint32_t i = 0;
  for (const double y_m : {-0.3, 0.25, 0.8}) {
    scene.add(still(Box{{0.9, 0.02, 0.15}}, {0.9, y_m, back_m + 0.16}, {0.85F, 0.80F, 0.70F}));
    for (const double x_m : {0.2, 0.42, 0.75, 1.05, 1.4, 1.6}) {
      const double half_m = 0.09 + 0.02 * (i % 4);
      const dvec3 at_m(x_m, y_m + 0.02 + half_m, back_m + 0.18);
      const Shape shape = i % 2 == 0 ? Shape(Cylinder{0.055, half_m})
                                     : Shape(Box{{0.05 + 0.01 * (i % 3), half_m, 0.08}});
      scene.add(still(shape, at_m, tint(i++)));
    }
  }
}

void addBalls(Scene& scene) {
  const auto ball = [&](const dvec3& at_m, double radius_m, uint32_t hue) -> Body& {
    return scene.add(still(Sphere{radius_m}, at_m, tint(hue)));
  };
  ball({-0.55, -0.285, -2.6}, 0.14, 3);
  ball({-1.35, -0.88, -3.4}, 0.32, 5);
  Body& rolling = ball({0.35, -1.02, -3.6}, 0.18, 7);
  rolling.velocity_mps = {0.36, 0, 0};
  rolling.spin_rad_per_s = {0, 0, -2};
  Body& flying = ball({0.30, 0.30, -1.9}, 0.11, 9);
  flying.velocity_mps = {-0.5, 0.2, 0.3};
  Body& spinning = scene.add(
      still(Box{{0.16, 0.16, 0.16}}, {-0.75, 0.45, -2.9}, tint(11), turned(0.9, {1, 2, 0.5})));
  spinning.spin_rad_per_s = {0.2, 0.9, 0};
}

}  // namespace

Scene clutteredRoom() {
  constexpr double kFloor_m = -1.2;
  constexpr double kCeiling_m = 1.5;
  constexpr double kBack_m = -5.5;
  Scene scene;
  addRoom({-2.2, kFloor_m, kBack_m}, {2.2, kCeiling_m, 2.0}, scene);
  addTableAndChair(kFloor_m, scene);
  addShelves(kBack_m, scene);
  addBalls(scene);
  for (const dvec3& at_m : {dvec3(-0.15, -0.28, -2.55), dvec3(0.1, -0.32, -2.8)}) {  // mugs
    scene.add(still(Cylinder{0.05, at_m.y - kTableTop_m}, at_m, tint(13)));
  }
  for (const dvec3& at_m : {dvec3(0.55, 0.55, -2.2), dvec3(-1.1, 0.8, -3.8)}) {  // lamps on rods
    const double half_m = 0.5 * (kCeiling_m - at_m.y);
    scene.add(
        still(Cylinder{0.008, half_m}, {at_m.x, at_m.y + half_m, at_m.z}, {0.5F, 0.5F, 0.55F}));
    scene.add(still(Sphere{0.12}, at_m, {0.95F, 0.85F, 0.55F}));
  }
  const double column_half_m = 0.5 * (kCeiling_m - kFloor_m);
  scene.add(still(Cylinder{0.16, column_half_m}, {1.55, kFloor_m + column_half_m, -3.9},
                  {0.82F, 0.82F, 0.78F}));
  scene.add(still(Box{{0.30, 0.22, 0.0}}, {-0.95, 0.0, -1.9}, {0.35F, 0.65F, 0.80F},
                  turned(0.5, {0.1, 1, 0})));
  scene.add(still(Box{{0.25, 0.25, 0.25}}, {-0.2, -0.95, -4.4}, tint(15), turned(0.6, {0, 1, 0})));
  scene.add(still(Box{{0.16, 0.16, 0.16}}, {-0.2, -0.54, -4.4}, tint(17), turned(1.1, {0, 1, 0})));
  return scene;
}

Scene thinStructures() {
  constexpr uint32_t kWires = 26;
  Scene scene;
  scene.add(still(Box{{6, 4, 0}}, {0, 0, -5}, {0.80F, 0.76F, 0.66F}));
  std::mt19937 random(11);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  for (uint32_t i = 0; i < kWires; ++i) {
    const double distance_m = uniform(1.5, 3.5);
    const dvec3 at_m(uniform(-0.5, 0.5) * distance_m, uniform(-0.35, 0.35) * distance_m,
                     -distance_m);
    const glm::dquat turn = turned(uniform(0, kHalfTurn), {uniform(-0.4, 0.4), 0, 1});
    scene.add(still(Cylinder{uniform(0.002, 0.008), uniform(0.3, 2)}, at_m, tint(i), turn));
  }
  for (uint32_t i = 0; i < 8; ++i) {  // a fence of slats and two rails
    scene.add(still(Box{{0.015, 0.5, 0.008}}, {-1.1 + 0.16 * i, -0.7, -3.0}, tint(40 + i)));
  }
  for (const double y_m : {-0.9, -0.4}) {
    scene.add(still(Box{{0.62, 0.012, 0.01}}, {-0.54, y_m, -3.02}, {0.50F, 0.38F, 0.26F}));
  }
  for (uint32_t i = 0; i < 7; ++i) {  // a net
    const double place_m = -0.3 + 0.1 * i;
    const glm::vec3 color = tint(60 + i);
    scene.add(still(Cylinder{0.003, 0.3}, {0.6 + place_m, 0.35, -2.2 - 0.3 * place_m}, color));
    scene.add(still(Cylinder{0.003, 0.32}, {0.6, 0.35 + place_m, -2.2}, color,
                    turned(kHalfTurn / 2, {0, 0.15, 1})));
  }
  return scene;
}

Scene largeSmooth() {
  constexpr double kGround_m = -1.6;
  Scene scene;
  scene.has_sky = true;
  const auto add = [&](const Shape& shape, const dvec3& at_m, const glm::vec3& color,
                       double wave_m) {
    Body& body = scene.add(still(shape, at_m, color));
    body.paint.wave_m = wave_m;
  };
  add(Box{{60, 0, 60}}, {0, kGround_m, -50}, {0.55F, 0.50F, 0.36F}, 1.5);
  add(Sphere{12}, {-7, kGround_m - 10.8, -16}, {0.45F, 0.65F, 0.32F}, 1.2);
  add(Sphere{20}, {9, kGround_m - 17.5, -24}, {0.38F, 0.60F, 0.40F}, 2);
  add(Sphere{60}, {-15, kGround_m - 54, -75}, {0.36F, 0.48F, 0.62F}, 6);
  add(Sphere{1.6}, {1.6, kGround_m + 0.9, -7.5}, {0.80F, 0.45F, 0.30F}, 0.5);
  return scene;
}

}  // namespace viewloom::truth
