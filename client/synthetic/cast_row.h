// SPDX-License-Identifier: Apache-2.0
// Peels one pixel row: the nearest camera-facing surfaces along each pixel's ray, exactly.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "synthetic/scene.h"

namespace viewloom::synthetic {

inline constexpr uint32_t kMaxLayers = 4;

enum class SurfaceKind : uint8_t { kSphere, kPole, kPanel, kRidge, kGround, kSky, kRod, kBackdrop };

struct Hit {
  double depth_m = 0;  // planar, along the view axis; +inf for the sky
  SurfaceKind kind = SurfaceKind::kSky;
  uint8_t index = 0;  // of the scene's list of this kind
};

// The first surfaces of one ray, nearest first.
struct HitColumn {
  std::array<Hit, kMaxLayers> hits;
  uint32_t count = 0;
};

// The rays of a row: eye + depth * (first + x * step) for pixel x. first and step are scaled so
// that depth is planar metres.
struct RowRays {
  glm::dvec3 eye_m{0.0};
  glm::dvec3 first{0.0};
  glm::dvec3 step{0.0};

  glm::dvec3 direction(size_t x) const { return first + static_cast<double>(x) * step; }
};

// Fills one column per pixel with up to layer_count (1..kMaxLayers) surfaces. A ray ends on the
// ground, on the backdrop or, with a hit at +inf, in the sky.
void castRow(const Scene& scene, const RowRays& rays, uint32_t layer_count,
             std::span<HitColumn> columns);

}  // namespace viewloom::synthetic
