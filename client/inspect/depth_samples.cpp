// SPDX-License-Identifier: Apache-2.0
#include "inspect/depth_samples.h"

#include <cmath>
#include <cstring>

#include <glm/gtc/packing.hpp>

#include "frame/depth.h"
#include "rpc/depth_format_from_proto.h"

namespace viewloom::inspect {
namespace {

constexpr float kHuge = 1e9F;

PlaneEncoding encodingOf(v1::PlaneEncoding encoding) {
  return encoding == v1::PLANE_ENCODING_DEPTH_F32   ? PlaneEncoding::kDepthF32
         : encoding == v1::PLANE_ENCODING_DEPTH_F16 ? PlaneEncoding::kDepthF16
                                                    : PlaneEncoding::kDepthU16;
}

float storedAt(const std::vector<uint8_t>& bytes, PlaneEncoding encoding, size_t index) {
  if (encoding == PlaneEncoding::kDepthF32) {
    float value = 0;
    std::memcpy(&value, &bytes[4 * index], sizeof(value));
    return value;
  }
  uint16_t value = 0;
  std::memcpy(&value, &bytes[2 * index], sizeof(value));
  return encoding == PlaneEncoding::kDepthF16 ? glm::unpackHalf1x16(value) : float(value);
}

// One sample by frame/depth.h.
class SampleReader {
 public:
  SampleReader(const DepthCoefficients& coefficients, const v1::Camera& camera,
               DepthSamples& samples)
      : c_(coefficients), camera_(camera.intrinsics()), samples_(samples) {}

  float read(float stored, uint32_t x, uint32_t y) {
    if (std::isfinite(stored) && std::abs(stored) >= kHuge) ++samples_.huge_count;
    if (c_.has_invalid != 0 && stored == c_.invalid_value) {
      return c_.invalid_is_far != 0 ? count(samples_.sky_count, 0)
                                    : count(samples_.invalid_count, kNoSurface);
    }
    const float value = (stored - c_.origin) * c_.scale + c_.offset;
    if (c_.reciprocal != 0 && value == 0) return count(samples_.invalid_count, kNoSurface);
    float inv_z = c_.reciprocal != 0 ? 1 / value : value;
    if (c_.ray_distance != 0) inv_z *= rayLength(x, y);
    if (!(inv_z >= 0) || inv_z > c_.inv_z_max) return count(samples_.bad_count, kNoSurface);
    if (inv_z == 0) return count(samples_.sky_count, 0);
    noteStored(stored);
    return inv_z;
  }

 private:
  static float count(uint64_t& counter, float inv_z) {
    ++counter;
    return inv_z;
  }

  // Of the ray through a px, per metre along the view axis.
  float rayLength(uint32_t x, uint32_t y) const {
    const double right = (x + 0.5 - camera_.principal_x_px()) / camera_.focal_x_px();
    const double down = (y + 0.5 - camera_.principal_y_px()) / camera_.focal_y_px();
    return static_cast<float>(std::sqrt(right * right + down * down + 1));
  }

  void noteStored(float stored) {
    const bool is_first = samples_.surface_count++ == 0;
    const auto note = [&](float& extreme, uint64_t& extreme_count, bool is_beyond) {
      if (is_first || is_beyond) extreme_count = 0;
      if (is_first || is_beyond) extreme = stored;
      if (stored == extreme) ++extreme_count;
    };
    note(samples_.stored_min, samples_.at_min_count, stored < samples_.stored_min);
    note(samples_.stored_max, samples_.at_max_count, stored > samples_.stored_max);
  }

  DepthCoefficients c_;
  v1::Intrinsics camera_;
  DepthSamples& samples_;
};

}  // namespace

absl::StatusOr<DepthSamples> readDepthSamples(const v1::Plane& plane,
                                              const std::vector<uint8_t>& bytes,
                                              const v1::Camera& camera) {
  const absl::StatusOr<DepthFormat> format = depthFormatFromProto(plane.depth());
  VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(format.status(), "depth"));
  const PlaneEncoding encoding = encodingOf(plane.encoding());
  VIEWLOOM_RETURN_IF_ERROR(validateDepthFormat(*format, encoding, "depth"));
  DepthSamples samples{.width_px = plane.size().width(), .height_px = plane.size().height()};
  DepthCoefficients coefficients = makeDepthCoefficients(*format, encoding);
  if (!camera.has_intrinsics()) coefficients.ray_distance = 0;
  SampleReader reader(coefficients, camera, samples);
  samples.inv_z.reserve(samples.sampleCount());
  for (uint32_t y = 0; y < samples.height_px; ++y) {
    for (uint32_t x = 0; x < samples.width_px; ++x) {
      samples.inv_z.push_back(reader.read(storedAt(bytes, encoding, samples.inv_z.size()), x, y));
    }
  }
  return samples;
}

}  // namespace viewloom::inspect
