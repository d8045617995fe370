// SPDX-License-Identifier: Apache-2.0
// A synthetic scene at one instant: the bodies that it may have, and the scene of the balls: balls,
// lamp posts, a floating panel, ground, two ridges, sky.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace viewloom::synthetic {

// How a surface mirrors, in a scene that is asked for mirrors.
enum class Finish : uint8_t { kMatt, kLake, kPolished, kPearl, kMetal, kChrome, kCopper };

// Metres, world space: +x right, +y up, -z into the scene.
struct Sphere {
  glm::dvec3 center_m{0.0};
  double radius_m = 0;
  double spin_rad = 0;    // around +y; turns the stripes
  glm::vec3 color{0.0F};  // linear light, 0..1
  glm::vec3 stripe_color{0.0F};
  glm::dvec3 velocity_mps{0.0};
  double spin_rad_per_s = 0;
  Finish finish = Finish::kMatt;
};

// An upright cylinder from the ground to top_y_m.
struct Pole {
  glm::dvec2 center_xz_m{0.0};
  double radius_m = 0;
  double top_y_m = 0;
};

// A cylinder of any direction without end faces. It shades nothing.
struct Rod {
  glm::dvec3 start_m{0.0};
  glm::dvec3 end_m{0.0};
  double radius_m = 0;
  glm::vec3 color{0.0F};  // linear light
  // It turns around the upright through pivot_m, which moves.
  glm::dvec3 pivot_m{0.0};
  double turn_rad_per_s = 0;
  glm::dvec3 velocity_mps{0.0};
};

// A flat rectangle, seen from both sides. right and up have unit length.
struct Panel {
  glm::dvec3 center_m{0.0};
  glm::dvec3 right{1.0, 0.0, 0.0};
  glm::dvec3 up{0.0, 1.0, 0.0};
  glm::dvec3 normal{0.0, 0.0, 1.0};
  glm::dvec2 half_size_m{0.0};
  glm::dvec3 velocity_mps{0.0};
  double turn_rad_per_s = 0;  // around its own upright
};

// A wall across the whole scene that faces +z and ends at a wavy crest.
struct Ridge {
  double z_m = 0;
  double crest_m = 0;
  double phase_rad = 0;
  glm::vec3 color{0.0F};  // linear light
  double scale = 1;       // size of its waves
  double half_width_m = std::numeric_limits<double>::infinity();

  static constexpr double kWave_m = 0.40;  // the crest stays within crest_m +- this, times scale

  double crestAt(double x_m) const;
  bool covers(double x_m, double y_m) const {
    if (x_m < -half_width_m || x_m > half_width_m) return false;
    if (y_m <= crest_m - kWave_m * scale) return true;
    return y_m <= crest_m + kWave_m * scale && y_m <= crestAt(x_m);
  }
};

// Three painted walls around the scene, left, right and behind, which end every ray. They are seen
// from inside alone, have no upper end, and no light or shadow falls on them.
struct Backdrop {
  double half_width_m = 0;  // the side walls are at x = +-half_width_m
  double front_z_m = 0;     // where the side walls begin
  double back_z_m = 0;
};

enum class Setting : uint8_t { kBalls, kPortrait };

struct Scene {
  std::vector<Sphere> spheres;
  std::vector<Pole> poles;
  std::vector<Rod> rods;
  Panel panel;
  std::array<Ridge, 2> ridges;  // nearer first
  std::optional<Backdrop> backdrop;
  glm::dvec3 to_sun{0.0};  // unit length
  double time_s = 0;
  double phase_rad = 0;               // of a setting that loops
  Setting setting = Setting::kBalls;  // chooses the textures
  Finish ground_finish = Finish::kLake;
  Finish panel_finish = Finish::kMetal;
  double ground_begin_m = std::numeric_limits<double>::infinity();  // no ground at a greater z
};

// The ground rises away from the camera: y = kGroundY_m + kGroundSlope * z, down to the far ridge.
inline constexpr double kGroundY_m = -0.85;
inline constexpr double kGroundSlope = -0.06;
inline constexpr double kGroundEnd_m = -8.0;  // z where it ends; the far ridge stands there

// The scene of the balls. The same time gives the same scene; it moves smoothly.
Scene makeScene(double time_s);

}  // namespace viewloom::synthetic
