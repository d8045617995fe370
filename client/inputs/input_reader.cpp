// SPDX-License-Identifier: Apache-2.0
#include "inputs/input_reader.h"

#include <Imath/half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <utility>

#include "absl/strings/str_cat.h"
#include "files/file_bytes.h"
#include "inputs/photo_frame.h"
#include "photos/photo.h"

namespace viewloom::inputs {
namespace {

constexpr double kDefaultFov_deg = 40;

// Least and largest finite sample of a depth plane of floats.
SampleRange rangeOfFloats(const v1::Plane& plane, const std::vector<uint8_t>& bytes) {
  const bool is_half = plane.encoding() == v1::PLANE_ENCODING_DEPTH_F16;
  SampleRange range{.black = std::numeric_limits<double>::infinity(),
                    .white = -std::numeric_limits<double>::infinity()};
  const size_t sample_bytes = is_half ? 2 : 4;
  for (size_t at = 0; at + sample_bytes <= bytes.size(); at += sample_bytes) {
    float sample = 0;
    if (is_half) {
      uint16_t bits = 0;
      std::memcpy(&bits, &bytes[at], sizeof(bits));
      sample = Imath::half(Imath::half::FromBits, bits);
    } else {
      std::memcpy(&sample, &bytes[at], sizeof(sample));
    }
    if (!std::isfinite(sample)) continue;
    range.black = std::min(range.black, double{sample});
    range.white = std::max(range.white, double{sample});
  }
  return range;
}

}  // namespace

absl::Status InputReader::settleDepth(const Interpretation& how, files::LoadedFrame& frame) {
  if (how.range == DepthRange::kStated || how.range == DepthRange::kBetween) {
    return absl::OkStatus();
  }
  v1::Plane& plane = *frame.wire.header.mutable_sources(0)->mutable_layers(0)->mutable_planes(1);
  SampleRange range{.black = 0, .white = double(frame.code_max.front())};
  if (frame.code_max.front() == 0) {
    if (how.kind == InputKind::kIphone) {  // floats are in 1/m as they are
      *plane.mutable_depth() = withSettings(plane.depth(), settings_);
      return absl::OkStatus();
    }
    if (!float_range_) float_range_ = rangeOfFloats(plane, *frame.wire.planes[1]);
    range = *float_range_;
    if (!(range.white > range.black)) {
      return files::refuseFile(how.source.layers(0).depth().file(),
                               "has the same value everywhere, which is no depth; accepted are at "
                               "least two different ones");
    }
  }
  absl::StatusOr<v1::DepthFormat> format = how.range == DepthRange::k2dPlusZ
                                               ? twoDPlusZFormat(settings_, range)
                                               : normalisedFormat(settings_, range);
  if (!format.ok()) {
    return absl::InvalidArgumentError(
        absl::StrCat("--input ", nameOf(how.kind), ": ", std::string(format.status().message())));
  }
  *plane.mutable_depth() = *std::move(format);
  return absl::OkStatus();
}

absl::StatusOr<ReadInput> InputReader::read(const InputFiles& files) {
  absl::StatusOr<Interpretation> how = interpret(settings_, files);
  if (!how.ok()) return how.status();
  v1::FrameManifest manifest;
  *manifest.add_sources() = how->source;
  absl::StatusOr<files::LoadedFrame> frame =
      photos::isPhoto(files.color) ? loadPhotoFrame(how->source) : files::loadFrame(manifest, "");
  if (!frame.ok()) return frame.status();
  VIEWLOOM_RETURN_IF_ERROR(settleDepth(*how, *frame));
  v1::Source& source = *frame->wire.header.mutable_sources(0);
  *source.mutable_camera() = settleCamera(settings_, *how, source.layers(0).planes(1).size());
  return ReadInput{*std::move(how), *std::move(frame)};
}

v1::Camera settleCamera(const InputSettings& settings, const Interpretation& how,
                        const v1::SizePx& depth_size) {
  v1::Camera camera = how.source.camera();
  const double width = depth_size.width(), height = depth_size.height();
  v1::Intrinsics& intrinsics = *camera.mutable_intrinsics();
  const bool is_stated = how.source.camera().has_intrinsics();
  if (is_stated && how.camera_size) {
    const double across = width / how.camera_size->width();
    const double down = height / how.camera_size->height();
    intrinsics.set_focal_x_px(intrinsics.focal_x_px() * across);
    intrinsics.set_focal_y_px(intrinsics.focal_y_px() * down);
    intrinsics.set_principal_x_px(intrinsics.principal_x_px() * across);
    intrinsics.set_principal_y_px(intrinsics.principal_y_px() * down);
  }
  if (!is_stated || settings.fov_y_deg || settings.focal_px) {
    const double half_rad =
        0.5 * settings.fov_y_deg.value_or(kDefaultFov_deg) * std::numbers::pi / 180;
    const double focal_px = settings.focal_px.value_or(0.5 * height / std::tan(half_rad));
    intrinsics.set_focal_x_px(focal_px / how.pixel_aspect);
    intrinsics.set_focal_y_px(focal_px);
  }
  if (!is_stated) {
    intrinsics.set_principal_x_px(0.5 * width);
    intrinsics.set_principal_y_px(0.5 * height);
  }
  if (settings.principal_px.size() == 2) {
    intrinsics.set_principal_x_px(settings.principal_px[0]);
    intrinsics.set_principal_y_px(settings.principal_px[1]);
  }
  return camera;
}

}  // namespace viewloom::inputs
