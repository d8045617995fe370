// SPDX-License-Identifier: Apache-2.0
#include "support/depth_reference.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>

#include "frame/depth.h"

namespace viewloom {
namespace {

double asBinary32(double value) {
  return static_cast<double>(static_cast<float>(value));
}

// A declared value is compared with samples as their encoding can hold it.
double storedAs(double value, PlaneEncoding encoding) {
  const auto rounded = static_cast<float>(value);
  return static_cast<double>(encoding == PlaneEncoding::kDepthF16
                                 ? glm::unpackHalf1x16(glm::packHalf1x16(rounded))
                                 : rounded);
}

DepthValue fromInvZ(double inv_z) {
  if (!(inv_z >= 0 && inv_z <= double{kInvZMax})) return {.kind = DepthClass::kBad};
  return {.kind = DepthClass::kSurface, .inv_z = inv_z};
}

DepthValue fromMetric(double metric_m, double ray_length) {
  if (metric_m == 0) return {.kind = DepthClass::kNoSurface};
  if (!(metric_m > 0)) return {.kind = DepthClass::kBad};
  return fromInvZ(ray_length / metric_m);
}

// Linear in 1/Z from near_z_m at min_depth to far_z_m at max_depth.
double windowInvZ(const DepthFormat& format, double depth) {
  const double min_depth = asBinary32(format.min_depth);
  const double share = (depth - min_depth) / (asBinary32(format.max_depth) - min_depth);
  return (1 - share) / format.near_z_m + share / format.far_z_m;
}

}  // namespace

DepthValue linearizeDepth(const DepthFormat& format, PlaneEncoding encoding, double sample,
                          glm::uvec2 pixel_px, const Intrinsics& intrinsics) {
  if (format.invalid_value && sample == storedAs(*format.invalid_value, encoding)) {
    return {.kind = format.invalid_is_far ? DepthClass::kSurface : DepthClass::kNoSurface};
  }
  const double value = sample * format.scale + format.offset;
  switch (format.meaning) {
    case DepthMeaning::kPlanar:
      return fromMetric(value, 1);
    case DepthMeaning::kRayDistance: {
      const glm::dvec2 ray =
          (glm::dvec2(pixel_px) + 0.5 - intrinsics.principal_px) / intrinsics.focal_px;
      return fromMetric(value, std::sqrt(1 + glm::dot(ray, ray)));
    }
    case DepthMeaning::kWindow:
      return fromInvZ(
          windowInvZ(format, encoding == PlaneEncoding::kDepthU16 ? sample / 65535 : sample));
    case DepthMeaning::kDisparity:
      return fromInvZ(value);
  }
  return {.kind = DepthClass::kBad};
}

}  // namespace viewloom
