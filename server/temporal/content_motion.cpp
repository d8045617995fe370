// SPDX-License-Identifier: Apache-2.0
#include "temporal/content_motion.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include <glm/common.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "frame/depth.h"

namespace viewloom {
namespace {

// Limit of a difference in 1/Z. A sample that is further off, or where one frame alone has a
// surface, lies on another surface.
constexpr double kOffMax = 0.1;
// Means below this may be rounding and noise: 1/Z of a source is connected to within 5 times that
// (kappa).
constexpr double kOffNoise = 0.001;
// How many times nearer one of the two must be to be believed.
constexpr double kClearRatio = 2;

// The first layer of a source.
class DepthReader {
 public:
  explicit DepthReader(const Frame& frame, size_t source)
      : format_(frame.format.sources[source]),
        plane_(format_.layers.front().depth),
        bytes_(frame.sources[source].front().depth->data()),
        coefficients_(makeDepthCoefficients(plane_.depth, plane_.encoding)) {}

  const Camera& camera() const { return format_.camera; }
  SizePx sizePx() const { return plane_.size_px; }

  // 1/m; none where there is no surface.
  std::optional<double> invZ(uint32_t x, uint32_t y) const {
    const float stored = storedAt(size_t{y} * plane_.size_px.width + x);
    const DepthCoefficients& c = coefficients_;
    if (c.has_invalid != 0 && stored == c.invalid_value) {
      return c.invalid_is_far != 0 ? std::optional(0.0) : std::nullopt;
    }
    const double value = (double{stored} - double{c.origin}) * double{c.scale} + double{c.offset};
    if (c.reciprocal == 0) return accepted(value);
    if (value == 0) return std::nullopt;
    return accepted((c.ray_distance != 0 ? lengthOf(ray(x, y)) : 1) / value);
  }

  // At a place in the image, px: of the sample there, or between the four around it, which is exact
  // on planes; whichever is nearer to what is `wanted`, as things end between samples.
  std::optional<double> invZAt(const glm::dvec2& at, double wanted) const {
    const std::optional<double> own = invZ(uint32_t(at.x), uint32_t(at.y));
    const glm::dvec2 last(sizePx().width - 1.0, sizePx().height - 1.0);
    const glm::dvec2 corner = glm::clamp(glm::floor(at - 0.5), glm::dvec2(0), last);
    const glm::dvec2 next = glm::min(corner + 1.0, last);
    const glm::dvec2 share = glm::clamp(at - 0.5 - corner, 0.0, 1.0);
    double between = 0;
    for (uint32_t i = 0; i < 4; ++i) {
      const glm::dvec2 px(i % 2 == 0 ? corner.x : next.x, i / 2 == 0 ? corner.y : next.y);
      const std::optional<double> sample = invZ(uint32_t(px.x), uint32_t(px.y));
      if (!sample) return own;
      between +=
          (i % 2 == 0 ? 1 - share.x : share.x) * (i / 2 == 0 ? 1 - share.y : share.y) * *sample;
    }
    return own && std::abs(*own - wanted) < std::abs(between - wanted) ? own : between;
  }

  // Per metre along the view axis, in the camera's space.
  glm::dvec3 ray(uint32_t x, uint32_t y) const {
    const Intrinsics& lens = camera().intrinsics;
    const glm::dvec2 slope = (glm::dvec2(x, y) + 0.5 - lens.principal_px) / lens.focal_px;
    return {slope.x, -slope.y, -1};
  }

 private:
  static double lengthOf(const glm::dvec3& ray) { return std::hypot(ray.x, ray.y, ray.z); }

  std::optional<double> accepted(double inv_z) const {
    const bool is_good = inv_z >= 0 && inv_z <= double{coefficients_.inv_z_max};
    return is_good ? std::optional(inv_z) : std::nullopt;
  }

  float storedAt(size_t index) const {
    if (plane_.encoding == PlaneEncoding::kDepthF32) {
      float value = 0;
      std::memcpy(&value, bytes_ + 4 * index, sizeof value);
      return value;
    }
    uint16_t value = 0;
    std::memcpy(&value, bytes_ + 2 * index, sizeof value);
    return plane_.encoding == PlaneEncoding::kDepthF16 ? glm::unpackHalf1x16(value) : float(value);
  }

  const SourceFormat& format_;
  const PlaneFormat& plane_;
  const uint8_t* bytes_;
  DepthCoefficients coefficients_;
};

// How far samples are off, of 1/Z, 0..kOffMax.
struct Apart {
  double sum = 0;
  uint32_t count = 0;

  void add(double wanted, const std::optional<double>& got) {
    const double nearer = std::max(wanted, got.value_or(0));
    const double off = nearer == 0 ? 0 : std::abs(wanted - got.value_or(0)) / nearer;
    sum += got ? std::min(off, kOffMax) : kOffMax;
    ++count;
  }
  double mean() const { return kOffNoise + (count == 0 ? 0 : sum / count); }
};

// Adds a sample, if it lies in the image of the camera that has moved.
void addStanding(const DepthReader& before, const DepthReader& now, const Pose& now_from_before,
                 const glm::uvec2& px, double inv_z, Apart& apart) {
  // Where it is seen, and its depth in units of the one before: of the sky too.
  const glm::dvec3 at =
      now_from_before.orientation * before.ray(px.x, px.y) + inv_z * now_from_before.position_m;
  if (at.z >= 0) return;
  const Intrinsics& lens = now.camera().intrinsics;
  const glm::dvec2 to = lens.principal_px + lens.focal_px * glm::dvec2(at.x, -at.y) / -at.z;
  const SizePx size_px = now.sizePx();
  if (!(to.x >= 0 && to.x < size_px.width && to.y >= 0 && to.y < size_px.height)) return;
  apart.add(inv_z / -at.z, now.invZAt(to, inv_z / -at.z));
}

}  // namespace

ContentMotion contentMotion(const Frame& before, const Frame& now, size_t source) {
  const SourceFormat& old_format = before.format.sources[source];
  const SourceFormat& new_format = now.format.sources[source];
  const SizePx size_px = new_format.layers.front().depth.size_px;
  if (old_format.camera.pose == new_format.camera.pose || new_format.is_cube_map ||
      old_format.is_cube_map || old_format.layers.front().depth.size_px != size_px ||
      old_format.camera.intrinsics != new_format.camera.intrinsics) {
    return ContentMotion::kUnclear;
  }
  const DepthReader from(before, source), to(now, source);
  const Pose now_from_before = compose(inverse(to.camera().pose), from.camera().pose);
  const auto step =
      uint32_t(std::max(std::ceil(std::sqrt(double(size_px.area()) / kComparedSamplesMax)), 1.0));
  Apart stands, with_camera;
  for (uint32_t y = step / 2; y < size_px.height; y += step) {
    for (uint32_t x = step / 2; x < size_px.width; x += step) {
      const std::optional<double> inv_z = from.invZ(x, y);
      if (!inv_z) continue;
      with_camera.add(*inv_z, to.invZ(x, y));
      addStanding(from, to, now_from_before, {x, y}, *inv_z, stands);
    }
  }
  // All but out of its image: there is little to compare.
  if (2 * stands.count < with_camera.count) return ContentMotion::kUnclear;
  if (kClearRatio * with_camera.mean() < stands.mean()) return ContentMotion::kWithCamera;
  if (kClearRatio * stands.mean() < with_camera.mean()) return ContentMotion::kStands;
  return ContentMotion::kUnclear;
}

bool movesByItself(const Frame& frame, size_t source) {
  return std::ranges::any_of(frame.sources[source],
                             [](const LayerPlanes& layer) { return layer.motion != nullptr; });
}

bool movesByItself(const Frame& frame) {
  for (size_t source = 0; source < frame.sources.size(); ++source) {
    if (movesByItself(frame, source)) return true;
  }
  return false;
}

}  // namespace viewloom
