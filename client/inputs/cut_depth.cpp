// SPDX-License-Identifier: Apache-2.0
#include "inputs/cut_depth.h"

#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "base/str_cat.h"
#include "inspect/depth_samples.h"
#include "inspect/stored_numbers.h"

namespace viewloom::inputs {
namespace {

// No depth has it by any meaning, and so it can stand for no surface.
constexpr float kCut = -1e30F;
constexpr float kU16Max = 65535;

absl::Status cutPlane(double farthest_m, const v1::Camera& camera, v1::Plane& plane,
                      SharedBytes& bytes) {
  const absl::StatusOr<inspect::DepthSamples> samples =
      inspect::readDepthSamples(plane, *bytes, camera);
  if (!samples.ok()) return samples.status();
  std::vector<float> stored = inspect::storedNumbers(plane, *bytes);
  v1::DepthFormat& format = *plane.mutable_depth();
  // The format's own number for "no surface" becomes the new one.
  for (size_t i = 0; i < stored.size(); ++i) {
    const bool is_far = samples->inv_z[i] >= 0 && samples->inv_z[i] * farthest_m < 1;
    if (is_far || samples->inv_z[i] < 0) {
      stored[i] = kCut;
    } else if (format.meaning() == v1::DEPTH_MEANING_WINDOW &&
               plane.encoding() == v1::PLANE_ENCODING_DEPTH_U16) {
      stored[i] /= kU16Max;  // as window depth counts floats
    }
  }
  format.set_invalid_value(kCut);
  format.set_invalid_is_far(false);
  plane.set_encoding(v1::PLANE_ENCODING_DEPTH_F32);
  std::vector<uint8_t> cut(4 * stored.size());
  std::memcpy(cut.data(), stored.data(), cut.size());
  plane.set_bytes_count(cut.size());
  bytes = std::make_shared<const std::vector<uint8_t>>(std::move(cut));
  return absl::OkStatus();
}

}  // namespace

absl::Status cutDepth(double farthest_m, v1::Source& source, WireFrame& wire) {
  if (!(farthest_m > 0)) {
    return absl::InvalidArgumentError(
        strCat("--no-surface-beyond is ", farthest_m, "; accepted are metres above 0"));
  }
  size_t index = 0;
  for (v1::Layer& layer : *source.mutable_layers()) {
    for (v1::Plane& plane : *layer.mutable_planes()) {
      if (plane.kind() == v1::PLANE_KIND_DEPTH) {
        VIEWLOOM_RETURN_IF_ERROR(cutPlane(farthest_m, source.camera(), plane, wire.planes[index]));
      }
      ++index;
    }
  }
  return absl::OkStatus();
}

}  // namespace viewloom::inputs
