// SPDX-License-Identifier: Apache-2.0
// Lenticular panels in their own pixels. Each subpixel shows what is seen from the place to which
// its lens directs it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/calibration.h"
#include "display/kind.h"

namespace viewloom {

// A lenticular panel in its own pixels (proto LenticularDisplay).
struct LenticularSpec {
  static constexpr const char* kName = "lenticular";

  std::string preset;
  std::string calibration_json;            // empty after completion
  std::optional<Calibration> calibration;  // set by completion
  uint32_t view_count = 0;  // subpixels show the nearest of so many views; 0 = their own view
  double view_cone_rad = 0;
  double focal_distance_m = 0;
  double fov_y_rad = 0;
};

inline constexpr uint32_t kLenticularViewsMax = 2500;

// Optics of a panel, as text: its calibration without the names of the device.
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

// NOT_FOUND for an unknown preset. FAILED_PRECONDITION for a preset without a published
// calibration.
absl::Status takePreset(LenticularSpec& lenticular);
absl::Status settle(LenticularSpec& lenticular);
TileGrid tileGrid(const LenticularSpec& lenticular);
// Lays out one view, from the middle of the cone.
void describe(const LenticularSpec& lenticular, const StreamDefaults& defaults,
              AtlasLayout& layout);
double* focalPlane(LenticularSpec& lenticular);
std::optional<OpenFov> openFov(const LenticularSpec& lenticular);
std::vector<KnownDevice> devicesOf(const LenticularSpec& any);

}  // namespace viewloom
