// SPDX-License-Identifier: Apache-2.0
#include "display/display_spec.h"

#include "absl/strings/str_cat.h"
#include "display/atlas_layout.h"
#include "display/camera_list.h"
#include "display/field_checks.h"
#include "display/integral.h"
#include "display/lenticular.h"
#include "display/quilt.h"
#include "display/rgbd.h"
#include "display/stereo.h"

namespace viewloom {
absl::StatusOr<DisplaySpec> completeDisplaySpec(DisplaySpec spec) {
  VIEWLOOM_RETURN_IF_ERROR(std::visit([](auto& kind) { return complete(kind); }, spec.kind));
  VIEWLOOM_RETURN_IF_ERROR(
      checkCount(spec.filter.sample_count, kFilterSampleCountMax, "filter.sample_count"));
  VIEWLOOM_RETURN_IF_ERROR(checkRange(spec.filter.width, 0, kFilterWidthMax, "filter.width"));
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
