// SPDX-License-Identifier: Apache-2.0
#include "synthetic/cast_row.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace viewloom::synthetic {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Keeps the nearest layer_count hits, sorted; the rest fall out at the far end.
void insertHit(HitColumn& column, const Hit& hit, uint32_t layer_count) {
  uint32_t place = column.count;
  while (place > 0 && hit.depth_m < column.hits[place - 1].depth_m) --place;
  if (place >= layer_count) return;
  column.count = std::min(column.count + 1, layer_count);
  for (uint32_t i = column.count - 1; i > place; --i) column.hits[i] = column.hits[i - 1];
  column.hits[place] = hit;
}

// A quadratic value over the row: v(x) = c0 + 2 c1 x + c2 x^2.
struct Quadratic {
  double c0, c1, c2;

  double at(double x) const { return c0 + x * (2.0 * c1 + x * c2); }
};

struct PixelSpan {
  size_t begin, end;
};

// The pixels where v may be >= 0, a pixel wider on both sides; the caller tests each of them.
PixelSpan spanWhereNotNegative(const Quadratic& v, size_t width) {
  if (v.c2 >= 0) return {0, width};
  const double root = v.c1 * v.c1 - v.c0 * v.c2;
  if (root < 0) return {0, 0};
  const double half = std::sqrt(root) / -v.c2;
  const double middle = v.c1 / -v.c2;
  const double last = static_cast<double>(width);
  return {static_cast<size_t>(std::clamp(std::floor(middle - half) - 1, 0.0, last)),
          static_cast<size_t>(std::clamp(std::ceil(middle + half) + 2, 0.0, last))};
}

// |o + t d|^2 = r^2 has real roots where discriminant >= 0; a, b as in a t^2 + 2 b t + c = 0.
struct RoundSurface {
  Quadratic a;
  double b0, b1;
  Quadratic discriminant;

  // first, step, offset: the rays and eye - centre, without the component along the axis if any.
  RoundSurface(const glm::dvec3& first, const glm::dvec3& step, const glm::dvec3& offset,
               double radius_m)
      : a{glm::dot(first, first), glm::dot(first, step), glm::dot(step, step)},
        b0(glm::dot(first, offset)),
        b1(glm::dot(step, offset)) {
    const double c = glm::dot(offset, offset) - radius_m * radius_m;
    discriminant = {b0 * b0 - a.c0 * c, b0 * b1 - a.c1 * c, b1 * b1 - a.c2 * c};
  }

  // Where the ray enters: the side that faces the camera. Negative or NaN: it does not.
  double entry(double x) const {
    return (-(b0 + x * b1) - std::sqrt(discriminant.at(x))) / a.at(x);
  }
};

glm::dvec3 withoutY(const glm::dvec3& v) {
  return {v.x, 0.0, v.z};
}

glm::dvec3 withoutAxis(const glm::dvec3& v, const glm::dvec3& axis) {
  return v - glm::dot(v, axis) * axis;
}

// Calls visit(x, depth_m) for every pixel whose ray enters the surface.
template <typename Visit>
void forEachEntry(const RoundSurface& surface, size_t width, const Visit& visit) {
  const PixelSpan span = spanWhereNotNegative(surface.discriminant, width);
  for (size_t x = span.begin; x < span.end; ++x) {
    const double depth_m = surface.entry(static_cast<double>(x));
    if (depth_m > 0) visit(x, depth_m);
  }
}

double groundDepth(const RowRays& rays, const glm::dvec3& direction, double begin_m) {
  // y = kGroundY_m + kGroundSlope z, met from above.
  const double height_m = rays.eye_m.y - kGroundY_m - kGroundSlope * rays.eye_m.z;
  const double fall = kGroundSlope * direction.z - direction.y;
  if (height_m <= 0 || fall <= 0) return kInfinity;
  const double depth_m = height_m / fall;
  const double z_m = rays.eye_m.z + depth_m * direction.z;
  return z_m < kGroundEnd_m || z_m > begin_m ? kInfinity : depth_m;
}

// Where a ray from inside meets a wall; +inf if it meets none.
double backdropDepth(const Backdrop& backdrop, const RowRays& rays, const glm::dvec3& direction) {
  double nearest_m = kInfinity;
  if (direction.z < 0) {
    const double depth_m = (backdrop.back_z_m - rays.eye_m.z) / direction.z;
    const double x_m = rays.eye_m.x + depth_m * direction.x;
    if (depth_m > 0 && std::abs(x_m) <= backdrop.half_width_m) nearest_m = depth_m;
  }
  if (direction.x != 0) {
    const double wall_m = std::copysign(backdrop.half_width_m, direction.x);
    const double depth_m = (wall_m - rays.eye_m.x) / direction.x;
    const double z_m = rays.eye_m.z + depth_m * direction.z;
    const bool is_met = depth_m > 0 && z_m <= backdrop.front_z_m && z_m >= backdrop.back_z_m;
    if (is_met) nearest_m = std::min(nearest_m, depth_m);
  }
  return nearest_m;
}

void castRidges(const Scene& scene, const RowRays& rays, uint32_t layer_count,
                std::span<HitColumn> columns) {
  for (size_t i = 0; i < scene.ridges.size(); ++i) {
    const Ridge& ridge = scene.ridges[i];
    for (size_t x = 0; x < columns.size(); ++x) {
      const glm::dvec3 direction = rays.direction(x);
      if (direction.z >= 0) continue;
      const double depth_m = (ridge.z_m - rays.eye_m.z) / direction.z;
      if (depth_m <= 0) continue;
      const glm::dvec3 point_m = rays.eye_m + depth_m * direction;
      if (!ridge.covers(point_m.x, point_m.y)) continue;
      insertHit(columns[x], {depth_m, SurfaceKind::kRidge, static_cast<uint8_t>(i)}, layer_count);
    }
  }
}

void castPanel(const Panel& panel, const RowRays& rays, uint32_t layer_count,
               std::span<HitColumn> columns) {
  const glm::dvec3 offset = rays.eye_m - panel.center_m;
  const double distance_m = -glm::dot(offset, panel.normal);
  const RoundSurface bound(rays.first, rays.step, offset, glm::length(panel.half_size_m));
  const PixelSpan span = spanWhereNotNegative(bound.discriminant, columns.size());
  for (size_t x = span.begin; x < span.end; ++x) {
    const glm::dvec3 direction = rays.direction(x);
    const double depth_m = distance_m / glm::dot(direction, panel.normal);
    if (!(depth_m > 0) || std::isinf(depth_m)) continue;
    const glm::dvec3 on_panel = offset + depth_m * direction;
    if (std::abs(glm::dot(on_panel, panel.right)) > panel.half_size_m.x ||
        std::abs(glm::dot(on_panel, panel.up)) > panel.half_size_m.y) {
      continue;
    }
    insertHit(columns[x], {depth_m, SurfaceKind::kPanel, 0}, layer_count);
  }
}

void castRods(const Scene& scene, const RowRays& rays, uint32_t layer_count,
              std::span<HitColumn> columns) {
  for (size_t i = 0; i < scene.rods.size(); ++i) {
    const Rod& rod = scene.rods[i];
    const double length_m = glm::length(rod.end_m - rod.start_m);
    const glm::dvec3 axis = (rod.end_m - rod.start_m) / length_m;
    const glm::dvec3 offset = rays.eye_m - rod.start_m;
    const RoundSurface surface(withoutAxis(rays.first, axis), withoutAxis(rays.step, axis),
                               withoutAxis(offset, axis), rod.radius_m);
    forEachEntry(surface, columns.size(), [&](size_t x, double depth_m) {
      const double along_m = glm::dot(offset + depth_m * rays.direction(x), axis);
      if (along_m < 0 || along_m > length_m) return;
      insertHit(columns[x], {depth_m, SurfaceKind::kRod, static_cast<uint8_t>(i)}, layer_count);
    });
  }
}

// The opaque end of each ray; what was found behind it is taken back.
void endRays(const Scene& scene, const RowRays& rays, uint32_t layer_count,
             std::span<HitColumn> columns) {
  for (size_t x = 0; x < columns.size(); ++x) {
    HitColumn& column = columns[x];
    const glm::dvec3 direction = rays.direction(x);
    double depth_m = groundDepth(rays, direction, scene.ground_begin_m);
    SurfaceKind kind = std::isinf(depth_m) ? SurfaceKind::kSky : SurfaceKind::kGround;
    if (scene.backdrop) {
      const double wall_m = backdropDepth(*scene.backdrop, rays, direction);
      if (wall_m < depth_m) {
        depth_m = wall_m;
        kind = SurfaceKind::kBackdrop;
      }
    }
    while (column.count > 0 && column.hits[column.count - 1].depth_m >= depth_m) --column.count;
    insertHit(column, {depth_m, kind, 0}, layer_count);
  }
}

}  // namespace

void castRow(const Scene& scene, const RowRays& rays, uint32_t layer_count,
             std::span<HitColumn> columns) {
  for (HitColumn& column : columns) column.count = 0;
  castRidges(scene, rays, layer_count, columns);
  castPanel(scene.panel, rays, layer_count, columns);
  for (size_t i = 0; i < scene.spheres.size(); ++i) {
    const Sphere& sphere = scene.spheres[i];
    const RoundSurface surface(rays.first, rays.step, rays.eye_m - sphere.center_m,
                               sphere.radius_m);
    forEachEntry(surface, columns.size(), [&](size_t x, double depth_m) {
      insertHit(columns[x], {depth_m, SurfaceKind::kSphere, static_cast<uint8_t>(i)}, layer_count);
    });
  }
  for (size_t i = 0; i < scene.poles.size(); ++i) {
    const Pole& pole = scene.poles[i];
    const glm::dvec3 offset{rays.eye_m.x - pole.center_xz_m.x, 0.0,
                            rays.eye_m.z - pole.center_xz_m.y};
    const RoundSurface surface(withoutY(rays.first), withoutY(rays.step), offset, pole.radius_m);
    forEachEntry(surface, columns.size(), [&](size_t x, double depth_m) {
      if (rays.eye_m.y + depth_m * rays.direction(x).y > pole.top_y_m) return;
      insertHit(columns[x], {depth_m, SurfaceKind::kPole, static_cast<uint8_t>(i)}, layer_count);
    });
  }
  castRods(scene, rays, layer_count, columns);
  endRays(scene, rays, layer_count, columns);
}

}  // namespace viewloom::synthetic
