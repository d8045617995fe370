// SPDX-License-Identifier: Apache-2.0
#include "support/truth/known.h"

#include <glm/geometric.hpp>

namespace viewloom::truth {
namespace {

bool isInImage(const Camera& camera, SizePx size_px, const glm::dvec3& direction) {
  const glm::dvec3 ray = glm::inverse(camera.pose.orientation) * direction;
  if (ray.z >= 0) return false;
  const Intrinsics& k = camera.intrinsics;
  const double x_px = k.principal_px.x + k.focal_px.x * ray.x / -ray.z;
  const double y_px = k.principal_px.y - k.focal_px.y * ray.y / -ray.z;
  return x_px >= 0 && y_px >= 0 && x_px < size_px.width && y_px < size_px.height;
}

// No two hits of a ray are on one body: what the source meets of this body is this very point,
// unless that lies on the body's far side.
uint8_t layerOf(const Instant& instant, const Ray& from_source, const Hit& seen) {
  const bool faces_away = seen.body != kSky && glm::dot(seen.normal, from_source.direction) >= 0;
  if (faces_away) return kFacingAway;
  const HitColumn column = instant.peel(from_source, kLayersMax);
  for (uint32_t layer = 0; layer < column.count; ++layer) {
    if (column.hits[layer].body == seen.body) return static_cast<uint8_t>(layer);
  }
  return kDeeper;
}

}  // namespace

uint8_t knownAlong(const Instant& instant, const Camera& source, SizePx source_px, const Ray& ray) {
  const HitColumn column = instant.peel(ray, 1);
  if (column.count == 0) return kEmpty;
  const Hit& seen = column.hits.front();
  const glm::dvec3& eye_m = source.pose.position_m;
  const glm::dvec3 direction =
      seen.body == kSky ? ray.direction : ray.origin_m + seen.depth * ray.direction - eye_m;
  if (!isInImage(source, source_px, direction)) return kOutside;
  return layerOf(instant, {eye_m, direction}, seen);
}

std::vector<uint8_t> knownFrom(const Instant& instant, const Camera& source, SizePx source_px,
                               const Camera& view, SizePx view_px) {
  std::vector<uint8_t> known;
  known.reserve(view_px.area());
  for (uint32_t y = 0; y < view_px.height; ++y) {
    for (uint32_t x = 0; x < view_px.width; ++x) {
      const Ray ray = rayThrough(view, {x + 0.5, y + 0.5});
      known.push_back(knownAlong(instant, source, source_px, ray));
    }
  }
  return known;
}

}  // namespace viewloom::truth
