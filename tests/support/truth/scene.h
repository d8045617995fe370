// SPDX-License-Identifier: Apache-2.0
// A scene of exact surfaces at one time: what any ray meets, in order.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "support/truth/body.h"

namespace viewloom::truth {

inline constexpr uint32_t kLayersMax = 4;

struct Scene {
  std::vector<Body> bodies;
  bool has_sky = false;  // infinitely far, behind everything; else there is nothing

  // The body in the scene, until the next one is added.
  Body& add(const Body& body);
};

inline constexpr uint32_t kSky = UINT32_MAX;  // in place of a body's index

struct Hit {
  double depth = 0;  // of the ray; +inf for the sky
  uint32_t body = kSky;
  glm::dvec3 normal{0.0};  // world, unit length, faces the ray's origin; 0 for the sky
};

// The first surfaces that face the origin of one ray, nearest first.
struct HitColumn {
  std::array<Hit, kLayersMax> hits;
  uint32_t count = 0;

  // A ray meets a body once at most. Null: not among these.
  const Hit* find(uint32_t body) const;
};

// Thread-safety: const methods may be called from any thread.
class Instant {
 public:
  Instant(const Scene& scene, double time_s);

  // Up to layer_count (1..kLayersMax) surfaces.
  HitColumn peel(const Ray& ray, uint32_t layer_count) const;

  // Colour of a hit. Linear light, 0..1; the same from wherever it is seen.
  glm::vec3 color(const Ray& ray, const Hit& hit) const;
  // How what the ray met mirrors.
  Gloss gloss(const Hit& hit) const;
  // How fast the material there moves, m/s in the world.
  glm::dvec3 motion_mps(const Ray& ray, const Hit& hit) const;

 private:
  struct PosedBody {
    Body body;
    Pose world_from_body;
    Pose body_from_world;
    double bound_m = 0;
  };

  std::vector<PosedBody> bodies_;
  bool has_sky_ = false;
};

}  // namespace viewloom::truth
