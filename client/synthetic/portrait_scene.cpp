// SPDX-License-Identifier: Apache-2.0
#include "synthetic/portrait_scene.h"

#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace viewloom::synthetic {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr double kEase_s = 2.0;  // in which the scene speeds up, and slows down

// The window is what the camera sees at the focal plane.
constexpr double kWindowHalfHeight_m = 0.3249 * kPortraitFocus_m;  // tan 18 degrees
constexpr double kWindowHalfWidth_m = 0.75 * kWindowHalfHeight_m;
constexpr double kBack_m = -3.80;

constexpr vec3 kGold{0.80F, 0.50F, 0.14F};
constexpr vec3 kPaintWhite{0.90F, 0.84F, 0.70F};
constexpr vec3 kLampLight{1.0F, 0.82F, 0.45F};
constexpr vec3 kString{0.13F, 0.12F, 0.14F};

constexpr dvec3 kHub_m{0.0, 0.50, -2.55};  // middle of the mobile
constexpr double kRim_m = 0.30;            // radius of its roof
constexpr double kRimY_m = 0.34;
constexpr double kSwing_m = 0.375;  // radius of the circle of its balls
constexpr double kBallRadius_m = 0.083;
constexpr std::array<vec3, 8> kBallColors{{{0.85F, 0.08F, 0.07F},
                                           {0.95F, 0.42F, 0.03F},
                                           {0.92F, 0.72F, 0.05F},
                                           {0.20F, 0.55F, 0.10F},
                                           {0.02F, 0.48F, 0.46F},
                                           {0.04F, 0.22F, 0.72F},
                                           {0.33F, 0.09F, 0.62F},
                                           {0.85F, 0.16F, 0.40F}}};

constexpr std::array<Pole, 4> kLampPosts{{
    {{-0.57, -2.90}, 0.010, -0.36},
    {{0.57, -2.90}, 0.010, -0.36},
    {{-0.46, -3.35}, 0.010, -0.14},
    {{0.46, -3.35}, 0.010, -0.14},
}};

struct Balloon {
  dvec3 base_m;
  dvec3 sway_m;
  double phase_rad;
  double radius_m;
  vec3 color;
};
constexpr std::array<Balloon, 2> kBalloons{{
    {{-0.36, 0.78, -3.30}, {0.05, 0.07, 0.06}, 0.4, 0.145, {0.80F, 0.10F, 0.10F}},
    {{0.42, 0.93, -3.50}, {0.06, 0.06, 0.04}, 2.6, 0.100, {0.05F, 0.30F, 0.65F}},
}};

// Where the loop is, and how fast it goes.
struct Phase {
  double angle_rad;  // 0 to a whole turn
  double speed_rad_per_s;
};

// The speed rises and falls along half a cosine, so that it has no jump.
Phase phaseAt(double time_s) {
  const double in_loop_s = time_s - kPortraitLoop_s * std::floor(time_s / kPortraitLoop_s);
  const double cruise = kTurn_rad / (kPortraitMoving_s - kEase_s);  // rad/s
  const auto eased = [&](double since_s) {  // the angle gone since the start or until the end
    const double x = std::numbers::pi * since_s / kEase_s;
    return Phase{cruise * 0.5 * (since_s - kEase_s / std::numbers::pi * std::sin(x)),
                 cruise * 0.5 * (1.0 - std::cos(x))};
  };
  const double left_s = kPortraitMoving_s - in_loop_s;
  if (left_s <= 0) return {0, 0};
  if (in_loop_s < kEase_s) return eased(in_loop_s);
  if (left_s < kEase_s) {
    const Phase left = eased(left_s);
    return {kTurn_rad - left.angle_rad, left.speed_rad_per_s};
  }
  return {cruise * (in_loop_s - 0.5 * kEase_s), cruise};
}

// A point of the mobile, `angle_rad` around its upright.
dvec3 around(double angle_rad, double radius_m, double y_m) {
  return {kHub_m.x + radius_m * std::sin(angle_rad), y_m,
          kHub_m.z + radius_m * std::cos(angle_rad)};
}

void addMobile(const Phase& phase, Scene& scene) {
  // The motion of a string is that of the mobile: the rise of its ball is left out.
  const auto rod = [&](const dvec3& start_m, const dvec3& end_m, double radius_m,
                       const vec3& color) {
    scene.rods.push_back({.start_m = start_m,
                          .end_m = end_m,
                          .radius_m = radius_m,
                          .color = color,
                          .pivot_m = kHub_m,
                          .turn_rad_per_s = phase.speed_rad_per_s});
  };
  constexpr double kStep_rad = kTurn_rad / kBallColors.size();
  for (size_t i = 0; i < kBallColors.size(); ++i) {
    const double angle_rad = phase.angle_rad + static_cast<double>(i) * kStep_rad;
    // Up and down twice in a turn, and its neighbour the other way.
    const double wave_rad = 2.0 * phase.angle_rad + static_cast<double>(i) * kTurn_rad / 2.0;
    const double ball_y_m = -0.20 + 0.07 * std::sin(wave_rad);
    const double rise_mps = 0.07 * 2.0 * std::cos(wave_rad) * phase.speed_rad_per_s;
    const dvec3 rim_m = around(angle_rad, kRim_m, kRimY_m);
    const dvec3 ball_m = around(angle_rad, kSwing_m, ball_y_m);
    rod(kHub_m, rim_m, 0.009, i % 2 == 0 ? kGold : kPaintWhite);
    rod(around(angle_rad, 0.03, kRimY_m - 0.04), rim_m, 0.005, kPaintWhite);
    rod(rim_m, around(angle_rad + kStep_rad, kRim_m, kRimY_m), 0.008, kGold);
    rod(rim_m, ball_m, 0.0045, kString);
    const dvec3 from_hub_m = ball_m - kHub_m;
    scene.spheres.push_back(
        {.center_m = ball_m,
         .radius_m = kBallRadius_m,
         .spin_rad = angle_rad,
         .color = kBallColors[i],
         .stripe_color = kPaintWhite,
         .velocity_mps =
             glm::cross(dvec3(0, phase.speed_rad_per_s, 0), from_hub_m) + dvec3(0, rise_mps, 0),
         .spin_rad_per_s = phase.speed_rad_per_s,
         .finish = i % 2 == 1 ? Finish::kPearl : Finish::kMatt});
  }
  rod(kHub_m, kHub_m + dvec3(0, 1.0, 0), 0.007, kGold);
  scene.spheres.push_back({.center_m = kHub_m,
                           .radius_m = 0.045,
                           .color = kGold,
                           .stripe_color = kGold,
                           .finish = Finish::kCopper});
}

void addBalloons(const Phase& phase, Scene& scene) {
  for (const Balloon& balloon : kBalloons) {
    const double angle_rad = phase.angle_rad + balloon.phase_rad;
    const dvec3 center_m =
        balloon.base_m +
        balloon.sway_m * dvec3(std::sin(angle_rad), std::sin(2.0 * angle_rad), std::cos(angle_rad));
    const dvec3 velocity_mps =
        phase.speed_rad_per_s * balloon.sway_m *
        dvec3(std::cos(angle_rad), 2.0 * std::cos(2.0 * angle_rad), -std::sin(angle_rad));
    scene.spheres.push_back({.center_m = center_m,
                             .radius_m = balloon.radius_m,
                             .spin_rad = phase.angle_rad,
                             .color = balloon.color,
                             .stripe_color = kPaintWhite,
                             .velocity_mps = velocity_mps,
                             .spin_rad_per_s = phase.speed_rad_per_s});
    const double drop_m = 1.75 * balloon.radius_m;
    const double basket_m = 0.18 * balloon.radius_m;
    const auto hang = [&](const dvec3& start_m, const dvec3& end_m, double radius_m,
                          const vec3& color) {
      scene.rods.push_back({.start_m = center_m + start_m,
                            .end_m = center_m + end_m,
                            .radius_m = radius_m,
                            .color = color,
                            .pivot_m = center_m,
                            .velocity_mps = velocity_mps});
    };
    for (const double side : {-1.0, 1.0}) {
      hang({0.75 * side * balloon.radius_m, -0.6 * balloon.radius_m, 0},
           {side * basket_m, -drop_m, 0}, 0.003, kString);
    }
    hang({0, -drop_m, 0}, {0, -drop_m - 1.6 * basket_m, 0}, basket_m, {0.40F, 0.22F, 0.08F});
  }
}

void addLampPosts(Scene& scene) {
  for (const Pole& post : kLampPosts) {
    scene.poles.push_back(post);
    scene.spheres.push_back({.center_m = {post.center_xz_m.x, post.top_y_m, post.center_xz_m.y},
                             .radius_m = 0.032,
                             .color = kLampLight,
                             .stripe_color = kLampLight});
  }
}

// Board below, gold bars at the other sides: a fixed edge on the focal plane.
void addFrame(Scene& scene) {
  constexpr double kBar_m = 0.022;
  const auto bar = [&](double start_x_m, double start_y_m, double end_x_m, double end_y_m) {
    scene.rods.push_back({.start_m = {start_x_m, start_y_m, -kPortraitFocus_m},
                          .end_m = {end_x_m, end_y_m, -kPortraitFocus_m},
                          .radius_m = kBar_m,
                          .color = kGold});
  };
  constexpr double kX_m = kWindowHalfWidth_m;
  constexpr double kY_m = kWindowHalfHeight_m;
  bar(-kX_m, -kY_m, -kX_m, kY_m);
  bar(kX_m, -kY_m, kX_m, kY_m);
  bar(-kX_m, kY_m, kX_m, kY_m);
  // From a little below the window up to the ground.
  const double top_m = kGroundY_m - kGroundSlope * kPortraitFocus_m + 0.012;
  const double bottom_m = -kWindowHalfHeight_m - 0.03;
  scene.panel.center_m = {0.0, 0.5 * (top_m + bottom_m), -kPortraitFocus_m};
  scene.panel.half_size_m = {kX_m, 0.5 * (top_m - bottom_m)};
  scene.panel_finish = Finish::kMatt;
}

}  // namespace

Scene makePortraitScene(double time_s) {
  const Phase phase = phaseAt(time_s);
  Scene scene;
  scene.setting = Setting::kPortrait;
  scene.time_s = time_s;
  scene.phase_rad = phase.angle_rad;
  addMobile(phase, scene);
  addBalloons(phase, scene);
  addLampPosts(scene);
  addFrame(scene);
  scene.ridges = {Ridge{.z_m = -3.48,
                        .crest_m = -0.30,
                        .phase_rad = 0.9,
                        .color = {0.12F, 0.36F, 0.14F},
                        .scale = 0.36,
                        .half_width_m = kWindowHalfWidth_m},
                  Ridge{.z_m = -3.62,
                        .crest_m = -0.02,
                        .phase_rad = 2.4,
                        .color = {0.20F, 0.30F, 0.46F},
                        .scale = 0.42,
                        .half_width_m = kWindowHalfWidth_m}};
  scene.backdrop = Backdrop{
      .half_width_m = kWindowHalfWidth_m, .front_z_m = -kPortraitFocus_m, .back_z_m = kBack_m};
  scene.to_sun = glm::normalize(dvec3(-0.50, 0.95, 0.62));
  scene.ground_begin_m = -kPortraitFocus_m;
  scene.ground_finish = Finish::kPolished;
  return scene;
}

}  // namespace viewloom::synthetic
