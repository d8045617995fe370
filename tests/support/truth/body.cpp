// SPDX-License-Identifier: Apache-2.0
#include "support/truth/body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

namespace viewloom::truth {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The part of a line that lies inside something convex; empty when it leaves before it enters.
struct Inside {
  double enter = -kInfinity;
  double leave = kInfinity;
  glm::dvec3 normal{0.0};  // where it enters, any length
};

constexpr Inside kNowhere{kInfinity, -kInfinity, {}};

Inside insideBoth(const Inside& a, const Inside& b) {
  return {std::max(a.enter, b.enter), std::min(a.leave, b.leave),
          a.enter >= b.enter ? a.normal : b.normal};
}

// Between two planes half_m before and behind the origin.
Inside insideSlab(const Ray& ray, glm::length_t axis, double half_m) {
  const double origin_m = ray.origin_m[axis];
  const double step = ray.direction[axis];
  if (step == 0) return std::abs(origin_m) <= half_m ? Inside{} : kNowhere;
  const double side = step > 0 ? -1 : 1;  // of the plane that it meets first
  Inside inside{(side * half_m - origin_m) / step, (-side * half_m - origin_m) / step, {}};
  inside.normal[axis] = side;
  return inside;
}

// |origin + t direction| <= radius. A cylinder is a circle: y left out.
Inside insideRound(const glm::dvec3& origin_m, const glm::dvec3& direction, double radius_m) {
  const double a = glm::dot(direction, direction);
  const double b = glm::dot(origin_m, direction);
  const double c = glm::dot(origin_m, origin_m) - radius_m * radius_m;
  if (a == 0) return c <= 0 ? Inside{} : kNowhere;
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return kNowhere;
  const double half = std::sqrt(discriminant);
  const double enter = (-b - half) / a;
  return {enter, (-b + half) / a, origin_m + enter * direction};
}

Inside insideOf(const Sphere& sphere, const Ray& ray) {
  return insideRound(ray.origin_m, ray.direction, sphere.radius_m);
}

Inside insideOf(const Box& box, const Ray& ray) {
  const Inside flat =
      insideBoth(insideSlab(ray, 0, box.half_m.x), insideSlab(ray, 1, box.half_m.y));
  return insideBoth(flat, insideSlab(ray, 2, box.half_m.z));
}

Inside insideOf(const Cylinder& cylinder, const Ray& ray) {
  const glm::dvec3 flat(1, 0, 1);
  return insideBoth(insideRound(ray.origin_m * flat, ray.direction * flat, cylinder.radius_m),
                    insideSlab(ray, 1, cylinder.half_m));
}

}  // namespace

glm::vec3 Paint::colorAt(const glm::dvec3& point_m, float contrast) const {
  // Unit vectors that lie along no axis and no face of a box.
  static const std::array<glm::dvec3, 3> kWaves = {glm::normalize(glm::dvec3(0.80, 0.45, 0.40)),
                                                   glm::normalize(glm::dvec3(-0.50, 0.70, 0.52)),
                                                   glm::normalize(glm::dvec3(0.30, -0.65, 0.70))};
  double height = 0;
  for (const glm::dvec3& wave : kWaves) {
    height += std::sin(2 * std::numbers::pi / wave_m * glm::dot(wave, point_m));
  }
  const auto share = static_cast<float>(height / (2 * kWaves.size()));
  return dark + (0.5F + contrast * share) * (light - dark);
}

Pose Body::poseAt(double time_s) const {
  Pose moved = pose;
  moved.position_m += time_s * velocity_mps;
  const double rate = glm::length(spin_rad_per_s);
  if (rate > 0) {
    moved.orientation = glm::angleAxis(rate * time_s, spin_rad_per_s / rate) * moved.orientation;
  }
  return moved;
}

std::optional<Entry> entryInto(const Shape& shape, const Ray& ray) {
  const Inside inside = std::visit([&](const auto& solid) { return insideOf(solid, ray); }, shape);
  if (!(inside.enter > 0 && inside.enter <= inside.leave)) return std::nullopt;
  return Entry{inside.enter, glm::normalize(inside.normal)};
}

double boundRadius(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->radius_m;
  if (const auto* box = std::get_if<Box>(&shape)) return glm::length(box->half_m);
  const auto& cylinder = std::get<Cylinder>(shape);
  return std::hypot(cylinder.radius_m, cylinder.half_m);
}

}  // namespace viewloom::truth
