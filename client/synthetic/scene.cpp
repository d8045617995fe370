// SPDX-License-Identifier: Apache-2.0
#include "synthetic/scene.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace viewloom::synthetic {
namespace {

// A ball's way: it swings around base_m by sway_m at its own rate.
struct BallPath {
  glm::dvec3 base_m;
  glm::dvec3 sway_m;
  double rate_rad_per_s;
  double phase_rad;
  double radius_m;
  glm::vec3 color;
  glm::vec3 stripe_color;
};

constexpr glm::vec3 kIvory{0.90F, 0.84F, 0.70F};

// x and z swing a quarter turn apart, so that a ball goes round; y swings twice as fast.
const std::array<BallPath, 7> kBalls{{
    {{-0.38, -0.20, -2.45}, {0.16, 0.07, 0.20}, 0.9, 0.0, 0.24, {0.85F, 0.10F, 0.08F}, kIvory},
    {{0.42, 0.12, -3.10}, {0.12, 0.12, 0.30}, 0.7, 1.7, 0.27, {0.05F, 0.32F, 0.75F}, kIvory},
    {{0.00, 0.02, -4.30}, {1.00, 0.10, 0.90}, 0.5, 0.0, 0.30, {0.95F, 0.55F, 0.05F}, kIvory},
    {{0.00, 0.10, -4.30}, {1.00, 0.10, 0.90}, 0.5, 3.1, 0.22, {0.10F, 0.55F, 0.20F}, kIvory},
    {{-1.75, 0.42, -5.30}, {0.25, 0.10, 0.20}, 0.6, 0.8, 0.46, {0.45F, 0.12F, 0.60F}, kIvory},
    {{1.85, -0.02, -4.70}, {0.15, 0.16, 0.30}, 0.8, 2.3, 0.38, {0.02F, 0.50F, 0.50F}, kIvory},
    {{-1.05, -0.28, -3.60}, {0.20, 0.04, 0.25}, 0.7, 4.0, 0.20, {0.90F, 0.25F, 0.40F}, kIvory},
}};

const std::array<Pole, 7> kPoles{{
    {{-0.72, -3.00}, 0.022, 0.52},
    {{0.10, -2.60}, 0.016, 0.30},
    {{0.88, -3.60}, 0.026, 0.70},
    {{-0.30, -4.90}, 0.030, 1.05},
    {{1.30, -5.40}, 0.032, 0.80},
    {{-1.35, -4.40}, 0.028, 0.85},
    {{2.40, -5.60}, 0.034, 1.00},
}};
constexpr double kLampRadius_m = 0.07;
constexpr glm::vec3 kLampColor{1.0F, 0.75F, 0.30F};

constexpr double kStripeTurnsPerRad = 1.3;  // how much faster a ball spins than it swings

Sphere ballAt(const BallPath& path, double time_s) {
  const double angle_rad = path.rate_rad_per_s * time_s + path.phase_rad;
  const glm::dvec3 swing{std::sin(angle_rad), std::sin(2.0 * angle_rad), std::cos(angle_rad)};
  return {.center_m = path.base_m + path.sway_m * swing,
          .radius_m = path.radius_m,
          .spin_rad = kStripeTurnsPerRad * angle_rad,
          .color = path.color,
          .stripe_color = path.stripe_color,
          .velocity_mps = path.rate_rad_per_s * path.sway_m *
                          glm::dvec3{std::cos(angle_rad), 2.0 * std::cos(2.0 * angle_rad),
                                     -std::sin(angle_rad)},
          .spin_rad_per_s = kStripeTurnsPerRad * path.rate_rad_per_s};
}

Panel panelAt(double time_s) {
  const double yaw_rad = 0.55 * std::sin(0.6 * time_s);
  Panel panel;
  panel.center_m = {0.15, 0.52 + 0.08 * std::sin(0.9 * time_s), -5.20};
  panel.right = {std::cos(yaw_rad), 0.0, -std::sin(yaw_rad)};
  panel.normal = glm::cross(panel.right, panel.up);
  panel.half_size_m = {0.80, 0.50};
  panel.velocity_mps = {0.0, 0.08 * 0.9 * std::cos(0.9 * time_s), 0.0};
  panel.turn_rad_per_s = 0.55 * 0.6 * std::cos(0.6 * time_s);
  return panel;
}

}  // namespace

double Ridge::crestAt(double x_m) const {
  const double x = x_m / scale;
  return crest_m + scale * 0.28 * std::sin(0.8 * x + phase_rad) +
         scale * 0.12 * std::sin(2.1 * x - phase_rad);
}

Scene makeScene(double time_s) {
  Scene scene;
  scene.time_s = time_s;
  for (const BallPath& path : kBalls) scene.spheres.push_back(ballAt(path, time_s));
  for (const size_t chrome : {1, 5}) scene.spheres[chrome].finish = Finish::kChrome;
  for (const size_t copper : {0, 4}) scene.spheres[copper].finish = Finish::kCopper;
  for (const Pole& pole : kPoles) {
    scene.poles.push_back(pole);
    scene.spheres.push_back({.center_m = {pole.center_xz_m.x, pole.top_y_m, pole.center_xz_m.y},
                             .radius_m = kLampRadius_m,
                             .color = kLampColor,
                             .stripe_color = kLampColor});
  }
  scene.panel = panelAt(time_s);
  scene.ridges = {
      Ridge{.z_m = -6.6, .crest_m = 0.20, .phase_rad = 0.4, .color = {0.10F, 0.33F, 0.20F}},
      Ridge{
          .z_m = kGroundEnd_m, .crest_m = 1.05, .phase_rad = 2.0, .color = {0.16F, 0.28F, 0.48F}}};
  scene.to_sun = glm::normalize(glm::dvec3{-0.55 + 0.25 * std::sin(0.2 * time_s), 0.80, 0.55});
  return scene;
}

}  // namespace viewloom::synthetic
