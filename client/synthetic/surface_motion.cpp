// SPDX-License-Identifier: Apache-2.0
#include "synthetic/surface_motion.h"

#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>

namespace viewloom::synthetic {
namespace {

// Of a body that turns around the upright through its centre.
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
  return glm::dvec3(0.0);
}

std::array<uint16_t, 3> halvesOf(const glm::dvec3& vector) {
  return {glm::packHalf1x16(float(vector.x)), glm::packHalf1x16(float(vector.y)),
          glm::packHalf1x16(float(vector.z))};
}

}  // namespace viewloom::synthetic
