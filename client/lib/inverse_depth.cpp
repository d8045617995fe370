// SPDX-License-Identifier: Apache-2.0
#include "lib/inverse_depth.h"

#include <cmath>
#include <cstring>
#include <variant>

#include "frame/cube_map.h"
#include "frame/depth.h"
#include "rpc/depth_format_from_proto.h"
#include "rpc/geometry_from_proto.h"

namespace viewloom {
namespace {

// Nothing where a server refuses it.
std::optional<DepthFormat> formatOf(const v1::DepthFormat& proto) {
  const absl::StatusOr<DepthFormat> format = depthFormatFromProto(proto);
  if (!format.ok()) return std::nullopt;
  if (!validateDepthFormat(*format, PlaneEncoding::kDepthF32, "depth").ok()) return std::nullopt;
  return *format;
}

float withinRange(float inv_z) {
  return inv_z <= kInvZMax ? inv_z : kNoInvZ;
}

float invZOf(float value, bool is_reciprocal) {
  if (!is_reciprocal) return value >= 0 ? withinRange(value) : kNoInvZ;  // NaN is no surface, too
  const float inv_z = 1 / value;
  return value > 0 ? withinRange(inv_z) : kNoInvZ;
}

// In place. Samples without a special value come by the million: nothing in their loops is decided
// anew for each.
void linearise(const DepthCoefficients& depth, std::span<float> row) {
  const auto valueOf = [&depth](float sample) {
    return (sample - depth.origin) * depth.scale + depth.offset;
  };
  if (depth.has_invalid != 0) {
    const float invalid = depth.invalid_is_far != 0 ? 0 : kNoInvZ;
    for (float& sample : row) {
      sample =
          sample == depth.invalid_value ? invalid : invZOf(valueOf(sample), depth.reciprocal != 0);
    }
  } else if (depth.reciprocal != 0) {
    for (float& sample : row) sample = invZOf(valueOf(sample), true);
  } else {
    for (float& sample : row) sample = invZOf(valueOf(sample), false);
  }
}

// Of planes that hold distances from the eye: how much longer than its Z the ray of a px is.
void divideByRayLength(const Intrinsics& intrinsics, size_t width, size_t rows_of_image,
                       std::vector<float>& inv_z) {
  for (size_t i = 0; i < inv_z.size(); ++i) {
    if (inv_z[i] <= 0) continue;
    const double x = (double(i % width) + 0.5 - intrinsics.principal_px.x) / intrinsics.focal_px.x;
    const double row = double(i / width % rows_of_image);
    const double y = (row + 0.5 - intrinsics.principal_px.y) / intrinsics.focal_px.y;
    inv_z[i] = withinRange(static_cast<float>(inv_z[i] * std::sqrt(x * x + y * y + 1)));
  }
}

}  // namespace

std::optional<Intrinsics> depthIntrinsics(const v1::Source& source) {
  SizePx size_px;
  for (const v1::Plane& plane : source.layers_size() > 0 ? source.layers(0).planes()
                                                         : v1::Layer::default_instance().planes()) {
    if (plane.kind() == v1::PLANE_KIND_DEPTH)
      size_px = {plane.size().width(), plane.size().height()};
  }
  if (size_px.area() == 0) return std::nullopt;
  if (source.cube_map()) return cubeFaceIntrinsics(size_px.width);
  const auto projection = projectionFromProto(source.camera());
  if (!projection.ok()) return std::nullopt;
  const Fov* const fov = std::get_if<Fov>(&*projection);
  const Intrinsics intrinsics =
      fov != nullptr ? intrinsicsFromFov(*fov, size_px) : std::get<Intrinsics>(*projection);
  if (!validateIntrinsics(intrinsics, "intrinsics").ok()) return std::nullopt;
  return intrinsics;
}

std::optional<std::vector<float>> inverseDepth(const v1::Plane& plane,
                                               std::span<const uint8_t> bytes,
                                               const Intrinsics& intrinsics, bool is_cube_map) {
  const std::optional<DepthFormat> format = formatOf(plane.depth());
  const size_t width = plane.size().width();
  const size_t height = plane.size().height();
  const size_t packed_bytes = width * sizeof(float);
  const size_t stride_bytes = plane.stride_bytes() == 0 ? packed_bytes : plane.stride_bytes();
  const bool fits = width * height > 0 && stride_bytes >= packed_bytes &&
                    bytes.size() / stride_bytes == height && bytes.size() % stride_bytes == 0;
  if (!format || !fits) return std::nullopt;
  const DepthCoefficients coefficients = makeDepthCoefficients(*format, PlaneEncoding::kDepthF32);
  std::vector<float> inv_z(width * height);
  for (size_t y = 0; y < height; ++y) {
    float* row = &inv_z[y * width];
    std::memcpy(row, &bytes[y * stride_bytes], packed_bytes);
    linearise(coefficients, {row, width});
  }
  if (coefficients.ray_distance != 0) {
    divideByRayLength(intrinsics, width, is_cube_map ? height / kCubeFaceCount : height, inv_z);
  }
  return inv_z;
}

}  // namespace viewloom
