// SPDX-License-Identifier: Apache-2.0
// Stereo pairs: two off-axis eyes on a line, or two given cameras; or one of them alone. A tracked
// display uses these eyes until tracked ones come (tracked_eyes.h).
#pragma once

#include <vector>

#include "display/kind.h"

namespace viewloom {

enum class StereoLayout : uint8_t { kSideBySide, kTopBottom, kSeparate, kSingle };
inline constexpr Word<StereoLayout> kStereoLayouts[] = {{"SIDE_BY_SIDE", StereoLayout::kSideBySide},
                                                        {"TOP_BOTTOM", StereoLayout::kTopBottom},
                                                        {"SEPARATE", StereoLayout::kSeparate},
                                                        {"SINGLE", StereoLayout::kSingle}};

struct StereoSpec {
  static constexpr const char* kName = "stereo";

  StereoLayout layout = StereoLayout::kSideBySide;
  SizePx eye_size_px;
  double eye_distance_m = 0;     // 0 = 0.063
  double focal_distance_m = 0;   // 0 = from the stream
  double fov_y_rad = 0;          // 0 = what the source sees
  std::vector<ViewCamera> eyes;  // none, or eyeCount()
  bool is_tracked = false;       // the eyes are those of EyePoses, once they come
};

inline uint32_t eyeCount(const StereoSpec& stereo) {
  return stereo.layout == StereoLayout::kSingle ? 1 : 2;
}

template <SpecOf<StereoSpec> Stereo, typename Visitor>
void visitFields(Stereo& stereo, Visitor& visit) {
  visit.word("layout", stereo.layout, kStereoLayouts);
  visit("eye_size", stereo.eye_size_px, Range{1, kEyeSidePxMax});
  visit("eye_distance_m", stereo.eye_distance_m, Range{0, 10});
  visit("focal_distance_m", stereo.focal_distance_m, kOptionalDistance);
  visit("fov_y_rad", stereo.fov_y_rad, kOptionalAngle);
  visit.cameras("eyes", stereo.eyes, Range{1, 2, true});
  visit("tracked", stereo.is_tracked);
}

absl::Status takePreset(StereoSpec& stereo);
absl::Status settle(StereoSpec& stereo);
TileGrid tileGrid(const StereoSpec& stereo);
// Lays out the eyes. Without given cameras two are at -/+ half the eye distance, a single one is in
// the middle, and all frame one rectangle on the focal plane.
void describe(const StereoSpec& stereo, const StreamDefaults& defaults, AtlasLayout& layout);
double* focalPlane(StereoSpec& stereo);
std::optional<OpenFov> openFov(const StereoSpec& stereo);
std::vector<KnownDevice> devicesOf(const StereoSpec& any);

}  // namespace viewloom
