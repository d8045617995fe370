// SPDX-License-Identifier: Apache-2.0
#include "display/display_spec.h"

#include <array>

#include "base/str_cat.h"
#include "display/atlas_layout.h"
#include "display/camera_list.h"
#include "display/field_checks.h"
#include "display/integral.h"
#include "display/lenticular.h"
#include "display/quilt.h"
#include "display/rgbd.h"
#include "display/stereo.h"

namespace viewloom {
namespace {

// By quality: draft, balanced, best.
constexpr std::array<double, 3> kTolerances_px = {1, kDefaultTolerance_px, 0.0625};

// Of the plane that all views frame.
double* focalDistanceOf(QuiltSpec& quilt) {
  return &quilt.focal_distance_m;
}
double* focalDistanceOf(StereoSpec& stereo) {
  const bool has_own_eyes = stereo.is_tracked || !stereo.eyes.empty();
  return has_own_eyes ? nullptr : &stereo.focal_distance_m;
}
double* focalDistanceOf(CamerasSpec& cameras) {
  return cameras.grid ? &cameras.grid->focal_distance_m : nullptr;
}
double* focalDistanceOf(LenticularSpec& lenticular) {
  return &lenticular.focal_distance_m;
}
double* focalDistanceOf(IntegralSpec&) {
  return nullptr;  // its panel stands where it stands
}
double* focalDistanceOf(RgbdSpec&) {
  return nullptr;  // one view frames nothing that others do
}

absl::Status checkFocusFollowing(const DisplaySpec& spec) {
  if (spec.focus_following_s == 0) return absl::OkStatus();
  VIEWLOOM_RETURN_IF_ERROR(checkRange(spec.focus_following_s, kFocusFollowingMin_s,
                                      kFocusFollowingMax_s, "focus_following_s"));
  if (withFocalDistance(spec, 1)) return absl::OkStatus();
  return invalidField(
      "focus_following_s",
      "came for a display without a focal plane to move; accepted for quilts, stereo "
      "without given or tracked eyes, grids of cameras and lenticular panels");
}

}  // namespace

std::optional<DisplaySpec> withFocalDistance(DisplaySpec spec, double focal_distance_m) {
  double* const place = std::visit([](auto& kind) { return focalDistanceOf(kind); }, spec.kind);
  if (place == nullptr) return std::nullopt;
  *place = focal_distance_m;
  return spec;
}

absl::StatusOr<DisplaySpec> completeDisplaySpec(DisplaySpec spec) {
  VIEWLOOM_RETURN_IF_ERROR(std::visit([](auto& kind) { return complete(kind); }, spec.kind));
  VIEWLOOM_RETURN_IF_ERROR(
      checkCount(spec.filter.sample_count, kFilterSampleCountMax, "filter.sample_count"));
  VIEWLOOM_RETURN_IF_ERROR(checkRange(spec.filter.width, 0, kFilterWidthMax, "filter.width"));
  VIEWLOOM_RETURN_IF_ERROR(checkFocusFollowing(spec));
  if (spec.lens) {
    VIEWLOOM_RETURN_IF_ERROR(
        withFieldPrefix(completeLens(*spec.lens, spec.quality), "effects.lens"));
  }
  if (spec.temporal) VIEWLOOM_RETURN_IF_ERROR(complete(*spec.temporal));
  if (spec.reflection) {
    VIEWLOOM_RETURN_IF_ERROR(
        withFieldPrefix(completeReflection(*spec.reflection, spec.quality), "effects.reflection"));
  }
  if (spec.world_pose) VIEWLOOM_RETURN_IF_ERROR(validatePose(*spec.world_pose, "world_pose"));
  VIEWLOOM_RETURN_IF_ERROR(checkRange(spec.tolerance_px, 0, kTolerancePxMax, "tolerance_px"));
  if (spec.tolerance_px == 0) spec.tolerance_px = kTolerances_px[size_t(spec.quality)];
  if (spec.background_rgb > 0xFFFFFF) {
    return invalidField("background_rgb", strCat("got 0x", absl::Hex(spec.background_rgb),
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
  if (encoding.planes == BandEncoding::kJpeg || encoding.planes == BandEncoding::kJpegPlanes) {
    return invalidField("planes", "got JPEG, which loses depth and mask; accepted is ZSTD or RAW");
  }
  return absl::OkStatus();
}

absl::Status validateEncodingOf(const DisplaySpec& spec, const EncodingSpec& encoding) {
  const bool shares_chroma =
      encoding.color == BandEncoding::kJpeg && encoding.chroma == Chroma::k420;
  if (!shares_chroma || !std::holds_alternative<LenticularSpec>(spec.kind)) return absl::OkStatus();
  return invalidField("chroma",
                      "got 420 for a lenticular panel, whose subpixels each show another view: "
                      "shared chroma mixes them; accepted are 444, JPEG_PLANES, ZSTD and RAW");
}

}  // namespace viewloom
