// SPDX-License-Identifier: Apache-2.0
#include "bench/lens_scene.h"

#include <cmath>
#include <numbers>

#include "base/worker_pool.h"
#include "support/truth/known.h"
#include "support/truth/picture.h"

namespace viewloom::bench {
namespace {

constexpr uint32_t kSourceWidth_px = 960;  // what it sees does not depend on it
constexpr double kSlope = 0.5;             // of the widest ray of the view, to the side

// Halton's sequence, which has nothing to do with what is scored.
double radicalInverse(uint32_t index, uint32_t base) {
  double inverse = 0;
  double digit = 1;
  for (; index > 0; index /= base) {
    digit /= base;
    inverse += digit * (index % base);
  }
  return inverse;
}

glm::dvec2 onDisc(double share, double turn) {
  const double angle_rad = 2 * std::numbers::pi * turn;
  return std::sqrt(share) * glm::dvec2(std::cos(angle_rad), std::sin(angle_rad));
}

// Exact rays over the area of a px and the lens, each of which goes to where the middle's ray
// through the same place of the px is in focus.
template <typename Seen>
void lookThrough(const Camera& camera, glm::dvec2 px, double radius_m, uint32_t ray_count,
                 const Seen& seen) {
  const Intrinsics& in = camera.intrinsics;
  for (uint32_t i = 0; i < ray_count; ++i) {
    const glm::dvec2 at = px + glm::dvec2(radicalInverse(i, 5), radicalInverse(i, 7));
    const glm::dvec2 eye_m = radius_m * onDisc(radicalInverse(i, 2), radicalInverse(i, 3));
    const glm::dvec2 slope = (at - in.principal_px) / in.focal_px;
    Camera moved = camera;
    moved.pose.position_m += glm::dvec3(eye_m, 0);
    const glm::dvec2 from_eye = slope - glm::dvec2(eye_m.x, -eye_m.y) / kLensFocus_m;
    seen(truth::rayThrough(moved, from_eye * in.focal_px + in.principal_px));
  }
}

glm::dvec3 trueLight(const truth::Instant& instant, const Camera& camera, glm::dvec2 px,
                     double radius_m, uint32_t ray_count) {
  glm::dvec3 light(0.0);
  lookThrough(camera, px, radius_m, ray_count, [&](const truth::Ray& ray) {
    const truth::HitColumn column = instant.peel(ray, 1);
    if (column.count > 0) light += glm::dvec3(instant.color(ray, column.hits[0]));
  });
  return light / double(ray_count);
}

double hiddenShare(const truth::Instant& instant, const Camera& camera, glm::dvec2 px,
                   double radius_m, uint32_t ray_count) {
  const SizePx size_px = lensPictureSize(kSourceWidth_px);
  const Camera source = lensCamera(kSourceWidth_px);
  uint32_t hidden_count = 0;
  lookThrough(camera, px, radius_m, ray_count, [&](const truth::Ray& ray) {
    const uint8_t layer = truth::knownAlong(instant, source, size_px, ray);
    hidden_count += layer > 0 && layer < truth::kLayersMax;
  });
  return double(hidden_count) / ray_count;
}

// `of_px`: of the place of a px.
template <typename OfPx>
void forEachPx(SizePx size_px, const OfPx& of_px) {
  WorkerPool workers;
  workers.forEach(size_px.height, [&](uint32_t y, uint32_t) {
    for (uint32_t x = 0; x < size_px.width; ++x) of_px(x, y, size_t{y} * size_px.width + x);
  });
}

}  // namespace

Camera lensCamera(uint32_t width_px, double aside_m) {
  const double height_px = width_px * 9.0 / 16;
  const double focal_px = width_px / (2 * kSlope);
  return {.pose = {.position_m = {aside_m, 0, 0}, .orientation = {1, 0, 0, 0}},
          .intrinsics = {.focal_px = {focal_px, focal_px},
                         .principal_px = {width_px / 2.0, height_px / 2}}};
}

SizePx lensPictureSize(uint32_t width_px) {
  return {width_px, width_px * 9 / 16};
}

std::vector<float> trueLensPicture(const truth::Instant& instant, const Camera& camera,
                                   SizePx size_px, double radius_m, uint32_t ray_count) {
  std::vector<float> light(3 * size_px.area());
  forEachPx(size_px, [&](uint32_t x, uint32_t y, size_t px) {
    const glm::dvec3 of_px = trueLight(instant, camera, {x, y}, radius_m, ray_count);
    for (int c = 0; c < 3; ++c) light[3 * px + c] = float(of_px[c]);
  });
  return light;
}

std::vector<float> hiddenShares(const truth::Instant& instant, const Camera& camera, SizePx size_px,
                                double radius_m, uint32_t ray_count) {
  std::vector<float> shares(size_px.area());
  forEachPx(size_px, [&](uint32_t x, uint32_t y, size_t px) {
    shares[px] = float(hiddenShare(instant, camera, {x, y}, radius_m, ray_count));
  });
  return shares;
}

}  // namespace viewloom::bench
