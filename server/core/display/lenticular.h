// SPDX-License-Identifier: Apache-2.0
// Lenticular panels in their own px: every subpixel shows what is seen from where its lens sends
// it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/calibration.h"
#include "display/kind.h"

namespace viewloom {

// A lenticular panel in its own px (proto LenticularDisplay).
struct LenticularSpec {
  static constexpr const char* kName = "lenticular";

  std::string preset;
  std::string calibration_json;            // empty once it is completed
  std::optional<Calibration> calibration;  // filled in with the rest
  uint32_t view_count = 0;  // subpixels show the nearest of so many views; 0 = each its own
  double view_cone_rad = 0;
  double focal_distance_m = 0;
  double fov_y_rad = 0;
};

inline constexpr uint32_t kLenticularViewsMax = 2500;

// What a panel shows depends on: its calibration without the names of the device.
std::string opticsOf(const LenticularSpec& lenticular);

template <SpecOf<LenticularSpec> Lenticular, typename Visitor>
void visitFields(Lenticular& lenticular, Visitor& visit) {
  visit.label("preset", lenticular.preset);
  visit.label("calibration_json", lenticular.calibration_json);
  visit.made([&] { return opticsOf(lenticular); });
  visit("view_count", lenticular.view_count, Range{1, kLenticularViewsMax, true});
  visit("view_cone_rad", lenticular.view_cone_rad, kOptionalAngle);
  visit("focal_distance_m", lenticular.focal_distance_m, kOptionalDistance);
  visit("fov_y_rad", lenticular.fov_y_rad, kOptionalAngle);
}

// NOT_FOUND for a preset that does not exist, FAILED_PRECONDITION for one whose panel no
// calibration is published of.
absl::Status takePreset(LenticularSpec& lenticular);
absl::Status settle(LenticularSpec& lenticular);
TileGrid tileGrid(const LenticularSpec& lenticular);
// One view, from the middle of the cone.
void describe(const LenticularSpec& lenticular, const StreamDefaults& defaults,
              AtlasLayout& layout);
double* focalPlane(LenticularSpec& lenticular);
std::optional<OpenFov> openFov(const LenticularSpec& lenticular);
std::vector<KnownDevice> devicesOf(const LenticularSpec& any);

}  // namespace viewloom
