// SPDX-License-Identifier: Apache-2.0
#include "lib/inverse_depth.h"

#include <cmath>
#include <cstring>
#include <variant>

#include "frame/cube_map.h"
#include "frame/decode_depth.h"
#include "messages/source_from_proto.h"

namespace viewloom {
namespace {

// Nothing where a server refuses it.
std::optional<DepthFormat> formatOf(const v1::DepthFormat& proto) {
  const absl::StatusOr<DepthFormat> format = depthFormatFromProto(proto);
  if (!format.ok()) return std::nullopt;
  if (!validateDepthFormat(*format, PlaneEncoding::kDepthF32, "depth").ok()) return std::nullopt;
  return *format;
}

// How much longer the ray through a px is than its part along the view axis.
class RayLengths {
 public:
  RayLengths(const Intrinsics& intrinsics, bool is_needed)
      : intrinsics_(intrinsics), is_needed_(is_needed) {}

  float at(size_t x, size_t y) const {
    if (!is_needed_) return 1;
    const double right = (double(x) + 0.5 - intrinsics_.principal_px.x) / intrinsics_.focal_px.x;
    const double down = (double(y) + 0.5 - intrinsics_.principal_px.y) / intrinsics_.focal_px.y;
    return static_cast<float>(std::sqrt(right * right + down * down + 1));
  }

 private:
  const Intrinsics& intrinsics_;
  bool is_needed_;
};

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
  const RayLengths ray_lengths(intrinsics, coefficients.ray_distance != 0);
  const size_t rows_of_image = is_cube_map ? height / kCubeFaceCount : height;
  std::vector<float> inv_z(width * height);
  for (size_t y = 0; y < height; ++y) {
    float* const row = &inv_z[y * width];
    std::memcpy(row, &bytes[y * stride_bytes], packed_bytes);
    for (size_t x = 0; x < width; ++x) {
      const DecodedDepth decoded =
          decodeDepth(coefficients, row[x], ray_lengths.at(x, y % rows_of_image));
      row[x] = decoded.isSurface() ? decoded.inv_z : kNoInvZ;
    }
  }
  return inv_z;
}

}  // namespace viewloom
