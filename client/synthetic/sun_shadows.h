// SPDX-License-Identifier: Apache-2.0
// Which share of the sun reaches a point of the synthetic scene.
#pragma once

#include <array>
#include <cstddef>

#include <glm/vec3.hpp>

#include "synthetic/cast_row.h"
#include "synthetic/scene.h"

namespace viewloom::synthetic {

// Shadows at one instant of the scene, which must outlive it. Most points lie in no ball's and no
// pole's shadow: a test of all at once finds them before any is looked at alone. Thread-safety:
// immutable.
class SunShadows {
 public:
  explicit SunShadows(const Scene& scene);

  // 0..1. A surface never shades itself here (its normal does).
  float sunShare(const Hit& hit, const glm::vec3& point_m) const;

 private:
  static constexpr size_t kSphereCountMax = 16;
  static constexpr size_t kPoleCountMax = 8;

  bool mayBeInASpheresShadow(const glm::vec3& point_m) const;
  bool mayBeInAPolesShadow(const glm::vec3& point_m) const;

  const Scene& scene_;
  glm::vec3 to_sun_;
  float flat_sun_length_;  // of to_sun without y
  // One array per coordinate, so that one instruction serves several of them. What is not used
  // shades nothing.
  struct {
    std::array<float, kSphereCountMax> x_m, y_m, z_m, reach_m2;
  } spheres_;
  struct {
    std::array<float, kPoleCountMax> x_m, z_m, reach_m;
  } poles_;
};

}  // namespace viewloom::synthetic
