// SPDX-License-Identifier: Apache-2.0
#include "inspect/depth_samples.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "frame/decode_depth.h"
#include "inspect/stored_numbers.h"
#include "messages/source_from_proto.h"

namespace viewloom::inspect {
namespace {

// Different huge numbers that are counted: renderers write one, filters make mixtures of it.
constexpr size_t kHugeKindsMax = 64;
// 8-bit codes stretched to 16 bits repeat their byte.
constexpr int kStretch = 257;

PlaneEncoding encodingOf(v1::PlaneEncoding encoding) {
  return encoding == v1::PLANE_ENCODING_DEPTH_F32   ? PlaneEncoding::kDepthF32
         : encoding == v1::PLANE_ENCODING_DEPTH_F16 ? PlaneEncoding::kDepthF16
                                                    : PlaneEncoding::kDepthU16;
}

class SampleReader {
 public:
  SampleReader(const DepthCoefficients& coefficients, const v1::Camera& camera,
               DepthSamples& samples)
      : c_(coefficients), camera_(camera.intrinsics()), samples_(samples) {}

  // 1/Z, or kNoSurface.
  float read(float stored, uint32_t x, uint32_t y) {
    const DecodedDepth decoded =
        decodeDepth(c_, stored, c_.ray_distance != 0 ? rayLength(x, y) : 1);
    switch (decoded.kind) {
      case DepthSampleKind::kSurface:
        noteStored(stored);
        return decoded.inv_z;
      case DepthSampleKind::kSky:
        ++samples_.sky_count;
        return 0;
      case DepthSampleKind::kNoSurface:
        ++samples_.invalid_count;
        return kNoSurface;
      case DepthSampleKind::kBad:
        noteBad(stored);
        return kNoSurface;
    }
    return kNoSurface;
  }

 private:
  // Length of the ray through a pixel, per metre along the view axis.
  float rayLength(uint32_t x, uint32_t y) const {
    const double right = (x + 0.5 - camera_.principal_x_px()) / camera_.focal_x_px();
    const double down = (y + 0.5 - camera_.principal_y_px()) / camera_.focal_y_px();
    return static_cast<float>(std::sqrt(right * right + down * down + 1));
  }

  void noteBad(float stored) {
    ++samples_.bad_count;
    if (std::isnan(stored)) ++samples_.bad_nan_count;
    if (std::isinf(stored) && stored < 0) ++samples_.bad_minus_infinity_count;
    if (std::isfinite(stored) && stored < 0) ++samples_.bad_negative_count;
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

HugeNumbers hugeNumbers(const std::vector<float>& stored) {
  HugeNumbers huge;
  std::map<float, uint64_t> counts;
  for (const float number : stored) {
    if (!std::isfinite(number) || std::abs(number) < kHuge) continue;
    ++huge.count;
    if (counts.size() < kHugeKindsMax || counts.contains(number)) ++counts[number];
  }
  for (const auto& [number, count] : counts) {
    if (count <= huge.most_frequent_count) continue;
    huge.most_frequent = number;
    huge.most_frequent_count = count;
  }
  return huge;
}

void noteNumbers(const v1::Plane& plane, const std::vector<float>& stored, DepthSamples& samples) {
  for (const float number : stored) {
    if (std::isfinite(number)) samples.largest_stored = std::max(samples.largest_stored, number);
  }
  samples.huge = hugeNumbers(stored);
  const ZeroPattern zeros = zeroPattern(stored, samples.width_px, samples.height_px);
  samples.has_scattered_zeros = zeros.isScattered();
  samples.has_points_alone = zeros.isOfPoints();
  samples.is_stretched = plane.encoding() == v1::PLANE_ENCODING_DEPTH_U16 &&
                         std::all_of(stored.begin(), stored.end(), [](float number) {
                           return static_cast<int>(number) % kStretch == 0;
                         });
}

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
  const std::vector<float> stored = storedNumbers(plane, bytes);
  SampleReader reader(coefficients, camera, samples);
  samples.inv_z.reserve(samples.sampleCount());
  for (uint32_t y = 0; y < samples.height_px; ++y) {
    for (uint32_t x = 0; x < samples.width_px; ++x) {
      samples.inv_z.push_back(reader.read(stored[samples.inv_z.size()], x, y));
    }
  }
  noteNumbers(plane, stored, samples);
  return samples;
}

}  // namespace viewloom::inspect
