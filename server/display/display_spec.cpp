// SPDX-License-Identifier: Apache-2.0
#include "display/display_spec.h"

#include <cmath>
#include <numbers>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "display/atlas_layout.h"
#include "display/camera_list.h"
#include "display/presets.h"

namespace viewloom {
namespace {

absl::Status checkCount(uint32_t value, uint32_t max, const std::string& field) {
  if (value >= 1 && value <= max) return absl::OkStatus();
  return invalidField(field, absl::StrCat("got ", value, ", accepted is 1..", max));
}

absl::Status checkSize(SizePx size, uint32_t max, const std::string& field) {
  VIEWLOOM_RETURN_IF_ERROR(checkCount(size.width, max, absl::StrCat(field, ".width")));
  return checkCount(size.height, max, absl::StrCat(field, ".height"));
}

// Written so that NaN fails.
absl::Status checkRange(double value, double min, double max, const std::string& field) {
  if (value >= min && value <= max) return absl::OkStatus();
  return invalidField(field, absl::StrCat("got ", value, ", accepted is ", min, "..", max));
}

// (0, max], or 0 for "not given".
absl::Status checkOptionalAngle(double value_rad, const std::string& field) {
  return checkRange(value_rad, 0, kViewAngleMax_rad, field);
}

absl::Status checkOptionalDistance(double value_m, const std::string& field) {
  if (value_m == 0) return absl::OkStatus();
  return checkRange(value_m, kFocalDistanceMin_m, kFocalDistanceMax_m, field);
}

absl::Status applyPreset(QuiltSpec& quilt) {
  if (quilt.preset.empty()) return absl::OkStatus();
  const Preset* preset = findPreset(quilt.preset);
  if (preset == nullptr) {
    const auto append_name = [](std::string* out, const Preset& p) { out->append(p.name); };
    return fieldError(absl::StatusCode::kNotFound, "quilt.preset",
                      absl::StrCat("there is no \"", quilt.preset, "\"; there are ",
                                   absl::StrJoin(allPresets(), ", ", append_name)));
  }
  const auto fill = [](auto& given, auto value) {
    if (given == 0) given = value;
  };
  fill(quilt.columns, preset->columns);
  fill(quilt.rows, preset->rows);
  if (quilt.size_px == SizePx{}) quilt.size_px = preset->size_px;
  fill(quilt.aspect, preset->aspect);
  fill(quilt.view_cone_rad, preset->view_cone_deg * std::numbers::pi / 180);
  return absl::OkStatus();
}

absl::Status complete(QuiltSpec& quilt) {
  VIEWLOOM_RETURN_IF_ERROR(applyPreset(quilt));
  VIEWLOOM_RETURN_IF_ERROR(checkCount(quilt.columns, kQuiltGridMax, "quilt.columns"));
  VIEWLOOM_RETURN_IF_ERROR(checkCount(quilt.rows, kQuiltGridMax, "quilt.rows"));
  VIEWLOOM_RETURN_IF_ERROR(checkSize(quilt.size_px, kQuiltSidePxMax, "quilt.size"));
  if (quilt.size_px.width < quilt.columns) {
    return invalidField("quilt.size.width",
                        absl::StrCat("got ", quilt.size_px.width, " px for ", quilt.columns,
                                     " columns, accepted is 1 px a tile or more"));
  }
  if (quilt.size_px.height < quilt.rows) {
    return invalidField("quilt.size.height",
                        absl::StrCat("got ", quilt.size_px.height, " px for ", quilt.rows,
                                     " rows, accepted is 1 px a tile or more"));
  }
  if (quilt.aspect != 0) {
    VIEWLOOM_RETURN_IF_ERROR(checkRange(quilt.aspect, kAspectMin, kAspectMax, "quilt.aspect"));
  }
  VIEWLOOM_RETURN_IF_ERROR(checkOptionalAngle(quilt.view_cone_rad, "quilt.view_cone_rad"));
  if (quilt.view_cone_rad == 0) quilt.view_cone_rad = kDefaultViewCone_rad;
  VIEWLOOM_RETURN_IF_ERROR(checkOptionalDistance(quilt.focal_distance_m, "quilt.focal_distance_m"));
  VIEWLOOM_RETURN_IF_ERROR(checkOptionalAngle(quilt.fov_y_rad, "quilt.fov_y_rad"));
  const uint32_t tile_count = quilt.columns * quilt.rows;
  if (quilt.view_count == 0) quilt.view_count = tile_count;
  return checkCount(quilt.view_count, tile_count, "quilt.view_count");
}

absl::Status complete(StereoSpec& stereo) {
  VIEWLOOM_RETURN_IF_ERROR(checkSize(stereo.eye_size_px, kEyeSidePxMax, "stereo.eye_size"));
  VIEWLOOM_RETURN_IF_ERROR(
      checkRange(stereo.eye_distance_m, 0, kEyeDistanceMax_m, "stereo.eye_distance_m"));
  if (stereo.eye_distance_m == 0) stereo.eye_distance_m = kDefaultEyeDistance_m;
  VIEWLOOM_RETURN_IF_ERROR(
      checkOptionalDistance(stereo.focal_distance_m, "stereo.focal_distance_m"));
  VIEWLOOM_RETURN_IF_ERROR(checkOptionalAngle(stereo.fov_y_rad, "stereo.fov_y_rad"));
  if (!stereo.eyes.empty() && stereo.eyes.size() != 2) {
    return invalidField("stereo.eyes",
                        absl::StrCat("got ", stereo.eyes.size(), ", accepted is none or two"));
  }
  return validateCameras(stereo.eyes, "stereo.eyes");
}

absl::Status complete(CamerasSpec& cameras) {
  const size_t count = cameras.cameras.size();
  if (count < 1 || count > kCameraCountMax) {
    return invalidField("cameras.cameras",
                        absl::StrCat("got ", count, ", accepted is 1..", kCameraCountMax));
  }
  VIEWLOOM_RETURN_IF_ERROR(checkSize(cameras.tile_size_px, kEyeSidePxMax, "cameras.tile_size"));
  if (cameras.columns == 0) {
    cameras.columns = static_cast<uint32_t>(std::ceil(std::sqrt(double(count))));
  }
  VIEWLOOM_RETURN_IF_ERROR(checkCount(cameras.columns, kCameraCountMax, "cameras.columns"));
  return validateCameras(cameras.cameras, "cameras.cameras");
}

}  // namespace

absl::StatusOr<DisplaySpec> completeDisplaySpec(DisplaySpec spec) {
  VIEWLOOM_RETURN_IF_ERROR(std::visit([](auto& kind) { return complete(kind); }, spec.kind));
  if (spec.world_pose) VIEWLOOM_RETURN_IF_ERROR(validatePose(*spec.world_pose, "world_pose"));
  VIEWLOOM_RETURN_IF_ERROR(checkRange(spec.tolerance_px, 0, kTolerancePxMax, "tolerance_px"));
  if (spec.tolerance_px == 0) spec.tolerance_px = kDefaultTolerance_px;
  if (spec.background_rgb > 0xFFFFFF) {
    return invalidField("background_rgb", absl::StrCat("got 0x", absl::Hex(spec.background_rgb),
                                                       ", accepted is 0..0xffffff"));
  }
  // Stills and browsers take any display as JPEG, so no atlas may be larger than a JPEG.
  VIEWLOOM_RETURN_IF_ERROR(validateAtlasLimits(
      spec,
      {.side_px_max = kJpegSidePxMax, .area_px_max = uint64_t{kJpegSidePxMax} * kJpegSidePxMax}));
  return spec;
}

absl::Status validateEncodingSpec(const EncodingSpec& encoding) {
  VIEWLOOM_RETURN_IF_ERROR(checkCount(encoding.jpeg_quality, 100, "jpeg_quality"));
  if (encoding.planes == BandEncoding::kJpeg) {
    return invalidField("planes", "got JPEG, which loses depth and mask; accepted is ZSTD or RAW");
  }
  return absl::OkStatus();
}

}  // namespace viewloom
