// SPDX-License-Identifier: Apache-2.0
#include "oracle/analytic_scenes.h"

#include <glm/geometric.hpp>

namespace viewloom::oracle {
namespace {

glm::dvec3 pointOn(const ImagePlane& plane, const Pinhole& pinhole, double x_px, double y_px) {
  const double z_m = 1 / plane.invZ(x_px, y_px);
  return {(x_px - pinhole.principal_px.x) / pinhole.focal_px.x * z_m,
          -(y_px - pinhole.principal_px.y) / pinhole.focal_px.y * z_m, -z_m};
}

Scene emptyScene(const char* name, int width, int height, int layer_count) {
  return {name,
          makePlanes(width, height, layer_count),
          {{1.25 * width, 1.25 * width}, {0.5 * width, 0.5 * height}},
          {1e-4f, 0}};
}

}  // namespace

Scene planeScene(const ImagePlane& plane, int width, int height) {
  return stepScene(plane, plane, 0, false, width, height);
}

Scene stepScene(const ImagePlane& near, const ImagePlane& far, int first_near_column,
                bool far_continues, int width, int height) {
  Scene scene = emptyScene("step", width, height, far_continues ? 2 : 1);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const bool is_near = column >= first_near_column;
      const double x_px = column + 0.5, y_px = row + 0.5;
      scene.planes.at(0, column, row) = float((is_near ? near : far).invZ(x_px, y_px));
      if (is_near && far_continues) scene.planes.at(1, column, row) = float(far.invZ(x_px, y_px));
    }
  }
  return scene;
}

std::optional<glm::dvec3> meet(const ImagePlane& plane, const Pinhole& pinhole, const Ray& ray) {
  const glm::dvec3 corner = pointOn(plane, pinhole, 0, 0);
  const glm::dvec3 normal =
      glm::cross(pointOn(plane, pinhole, 1, 0) - corner, pointOn(plane, pinhole, 0, 1) - corner);
  const double approach = glm::dot(normal, ray.direction);
  if (approach == 0) return std::nullopt;
  const double distance = glm::dot(normal, corner - ray.origin_m) / approach;
  if (distance < 0) return std::nullopt;
  return ray.origin_m + distance * ray.direction;
}

glm::dvec3 imageOf(const Pinhole& pinhole, const glm::dvec3& point_m) {
  const double z_m = -point_m.z;
  return {pinhole.principal_px.x + pinhole.focal_px.x * point_m.x / z_m,
          pinhole.principal_px.y - pinhole.focal_px.y * point_m.y / z_m, 1 / z_m};
}

}  // namespace viewloom::oracle
