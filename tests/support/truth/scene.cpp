// SPDX-License-Identifier: Apache-2.0
#include "support/truth/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "base/check.h"

namespace viewloom::truth {
namespace {

// Seen from the world's origin waves this long have faded out, and ones twice as long are whole:
// 10 px and 20 px of a picture with a focal length of 560 px.
constexpr double kWaveLeast_rad = 0.018;

constexpr float kAmbient = 0.45F;
constexpr float kSun = 0.55F;  // added to the ambient light: at most 1 in all

// Keeps the nearest layer_count hits in order; the rest fall out at the far end.
void insertHit(HitColumn& column, const Hit& hit, uint32_t layer_count) {
  uint32_t place = column.count;
  while (place > 0 && hit.depth < column.hits[place - 1].depth) --place;
  if (place >= layer_count) return;
  column.count = std::min(column.count + 1, layer_count);
  for (uint32_t i = column.count - 1; i > place; --i) column.hits[i] = column.hits[i - 1];
  column.hits[place] = hit;
}

Ray seenFrom(const Pose& body_from_world, const Ray& ray) {
  return {body_from_world.orientation * ray.origin_m + body_from_world.position_m,
          body_from_world.orientation * ray.direction};
}

bool passesWithin(double bound_m, const glm::dvec3& center_m, const Ray& ray) {
  const glm::dvec3 offset = center_m - ray.origin_m;
  const double along = glm::dot(offset, ray.direction);
  const double length2 = glm::dot(ray.direction, ray.direction);
  return (glm::dot(offset, offset) - bound_m * bound_m) * length2 <= along * along;
}

// Waves end where they would be too short for a picture. Measured from the world's origin and not
// from the eye, so that a point looks the same in every view.
float contrastOf(double wave_m, const glm::dvec3& point_m, const glm::dvec3& normal) {
  const double facing = std::abs(glm::dot(normal, point_m)) / glm::dot(point_m, point_m);
  const double share = wave_m * facing / kWaveLeast_rad - 1;
  return static_cast<float>(std::clamp(share, 0.0, 1.0));
}

glm::vec3 skyColor(const glm::dvec3& direction) {
  const glm::vec3 ray(glm::normalize(direction));
  const float cloud =
      0.5F + 0.5F * std::sin(11.0F * ray.x + 4.0F * ray.y) * std::sin(13.0F * ray.y);
  return glm::mix(glm::vec3(0.25F, 0.42F, 0.75F), glm::vec3(0.80F, 0.84F, 0.90F), cloud);
}

}  // namespace

Body& Scene::add(const Body& body) {
  return bodies.emplace_back(body);
}

const Hit* HitColumn::find(uint32_t body) const {
  const auto* const end = hits.data() + count;
  const auto* const found =
      std::find_if(hits.data(), end, [&](const Hit& hit) { return hit.body == body; });
  return found == end ? nullptr : found;
}

Instant::Instant(const Scene& scene, double time_s) : has_sky_(scene.has_sky) {
  for (const Body& body : scene.bodies) {
    const Pose pose = body.poseAt(time_s);
    bodies_.push_back({body, pose, inverse(pose), boundRadius(body.shape)});
  }
}

HitColumn Instant::peel(const Ray& ray, uint32_t layer_count) const {
  VIEWLOOM_CHECK(layer_count >= 1 && layer_count <= kLayersMax);
  HitColumn column;
  for (uint32_t i = 0; i < bodies_.size(); ++i) {
    const PosedBody& posed = bodies_[i];
    if (!passesWithin(posed.bound_m, posed.world_from_body.position_m, ray)) continue;
    const auto entry = entryInto(posed.body.shape, seenFrom(posed.body_from_world, ray));
    if (!entry) continue;
    insertHit(column, {entry->depth, i, posed.world_from_body.orientation * entry->normal},
              layer_count);
  }
  if (has_sky_ && column.count < layer_count) {
    insertHit(column, {.depth = std::numeric_limits<double>::infinity()}, layer_count);
  }
  return column;
}

glm::vec3 Instant::color(const Ray& ray, const Hit& hit) const {
  if (hit.body == kSky) return skyColor(ray.direction);
  static const glm::dvec3 kToSun = glm::normalize(glm::dvec3(-0.5, 0.8, 0.6));
  const PosedBody& posed = bodies_[hit.body];
  const Ray own = seenFrom(posed.body_from_world, ray);
  const auto facing = static_cast<float>(std::max(0.0, glm::dot(hit.normal, kToSun)));
  const glm::dvec3 point_m = ray.origin_m + hit.depth * ray.direction;
  const float contrast = contrastOf(posed.body.paint.wave_m, point_m, hit.normal);
  return posed.body.paint.colorAt(own.origin_m + hit.depth * own.direction, contrast) *
         (kAmbient + kSun * facing);
}

Gloss Instant::gloss(const Hit& hit) const {
  return hit.body == kSky ? Gloss{} : bodies_[hit.body].body.gloss;
}

glm::dvec3 Instant::motion_mps(const Ray& ray, const Hit& hit) const {
  if (hit.body == kSky) return glm::dvec3(0.0);
  const PosedBody& posed = bodies_[hit.body];
  const glm::dvec3 from_center =
      ray.origin_m + hit.depth * ray.direction - posed.world_from_body.position_m;
  return posed.body.velocity_mps + glm::cross(posed.body.spin_rad_per_s, from_center);
}

}  // namespace viewloom::truth
