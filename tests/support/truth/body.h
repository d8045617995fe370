// SPDX-License-Identifier: Apache-2.0
// A convex body with an exact surface, where rays enter it, and how it moves and is painted.
#pragma once

#include <optional>
#include <variant>

#include <glm/vec3.hpp>

#include "frame/camera.h"

namespace viewloom::truth {

// Points origin_m + depth * direction; the direction has any length, and depth counts in it.
struct Ray {
  glm::dvec3 origin_m{0.0};
  glm::dvec3 direction{0.0};
};

struct Sphere {
  double radius_m = 0;
};

// Two sides apart by 0 make a sheet, which is seen from both sides.
struct Box {
  glm::dvec3 half_m{0.0};
};

// Around its own y axis, closed by two discs.
struct Cylinder {
  double radius_m = 0;
  double half_m = 0;
};

using Shape = std::variant<Sphere, Box, Cylinder>;

// Waves of two colours through the body, like marble; none is shorter than wave_m.
struct Paint {
  glm::vec3 light{0.0F};  // linear light, 0..1
  glm::vec3 dark{0.0F};
  double wave_m = 1;

  // At a point of the body's own space. Contrast 0..1: 0 = the mean of both colours.
  glm::vec3 colorAt(const glm::dvec3& point_m, float contrast) const;
};

// Reflection of a surface: its share of the light head on, and how much it spreads it (the square
// root of the width of GGX).
struct Gloss {
  glm::vec3 light{0.0F};
  float roughness = 0;

  bool mirrors() const { return light != glm::vec3(0.0F); }
};

struct Body {
  Shape shape;
  Pose pose;  // at time 0
  Paint paint;
  Gloss gloss = {};
  glm::dvec3 velocity_mps{0.0};    // of its centre, in the world
  glm::dvec3 spin_rad_per_s{0.0};  // around its centre; the axis is the world's

  Pose poseAt(double time_s) const;
};

struct Entry {
  double depth = 0;
  glm::dvec3 normal{0.0};  // unit length; faces the ray's origin
};

// Where the ray enters the shape, in the shape's space. None when it misses, or begins inside or
// beyond. A ray enters a convex shape once at most: each body is one layer at most.
std::optional<Entry> entryInto(const Shape& shape, const Ray& ray);

// Radius of the sphere around the body's centre that encloses it.
double boundRadius(const Shape& shape);

}  // namespace viewloom::truth
