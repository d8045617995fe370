// SPDX-License-Identifier: Apache-2.0
#include "display/lenticular.h"

#include <cmath>
#include <numbers>

#include "base/str_cat.h"
#include "calibration/make_lenticular.h"
#include "display/atlas_layout.h"
#include "display/focal_window.h"
#include "display/presets.h"

namespace viewloom {
namespace {

absl::Status takePanel(LenticularSpec& lenticular) {
  if (lenticular.preset.empty()) {
    return invalidField("lenticular.calibration_json",
                        "no calibration is given; accepted is the text of the device's own "
                        "visual.json, or a preset");
  }
  VIEWLOOM_RETURN_IF_ERROR(checkPreset(lenticular.preset, "lenticular.preset"));
  lenticular.calibration = panelOfPreset(lenticular.preset);
  if (lenticular.calibration) return absl::OkStatus();
  return fieldError(
      absl::StatusCode::kFailedPrecondition, "lenticular.preset",
      strCat("no calibration of \"", lenticular.preset,
             "\" is published; give the text of the device's own visual.json as calibration_json"));
}

}  // namespace

std::string opticsOf(const LenticularSpec& lenticular) {
  Calibration calibration = *lenticular.calibration;
  calibration.serial.clear();
  calibration.config_version.clear();
  return writeCalibration(calibration);
}

absl::Status takePreset(LenticularSpec& lenticular) {
  if (lenticular.calibration_json.empty()) {
    return lenticular.calibration ? absl::OkStatus() : takePanel(lenticular);
  }
  absl::StatusOr<Calibration> parsed = parseCalibration(lenticular.calibration_json);
  VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(parsed.status(), "lenticular.calibration_json"));
  lenticular.calibration = *std::move(parsed);
  lenticular.calibration_json.clear();
  return absl::OkStatus();
}

absl::Status settle(LenticularSpec& lenticular) {
  if (lenticular.view_cone_rad != 0) return absl::OkStatus();
  lenticular.view_cone_rad = lenticular.calibration->view_cone_deg * std::numbers::pi / 180;
  return checkRange(lenticular.view_cone_rad, kOptionalAngle,
                    "lenticular.calibration_json.viewCone (in rad)");
}

double* focalPlane(LenticularSpec& lenticular) {
  return &lenticular.focal_distance_m;
}

std::optional<OpenFov> openFov(const LenticularSpec& lenticular) {
  return OpenFov{"lenticular.fov_y_rad", lenticular.fov_y_rad};
}

std::vector<KnownDevice> devicesOf(const LenticularSpec&) {
  std::vector<KnownDevice> devices;
  for (const Preset& preset : allPresets()) {
    const std::optional<Calibration> panel = panelOfPreset(preset.name);
    if (!panel) continue;
    devices.push_back({.name = preset.name,
                       .device = preset.device,
                       .note = preset.note,
                       .panel_px = panel->screen_px,
                       .panel_dpi = panel->dpi});
  }
  return devices;
}

TileGrid tileGrid(const LenticularSpec& lenticular) {
  const SizePx screen_px = lenticular.calibration->screen_px;
  return {.size_field = "lenticular.calibration_json",
          .columns = 1,
          .rows = 1,
          .tile_size_px = screen_px,
          .order = TileOrder::kTopLeft,
          .view_count = 1,
          .width_px = screen_px.width,
          .height_px = screen_px.height,
          .rays_per_px = 3};
}

void describe(const LenticularSpec& lenticular, const StreamDefaults& defaults,
              AtlasLayout& layout) {
  const double distance_m = focalDistance(lenticular.focal_distance_m, defaults);
  layout.focal_distance_m = distance_m;
  layout.eye_focus_m = distance_m;
  layout.view_cone_rad = lenticular.view_cone_rad;
  layout.rays = LenticularRays{.calibration = *lenticular.calibration,
                               .view_cone_rad = lenticular.view_cone_rad,
                               .distance_m = distance_m,
                               .view_count = lenticular.view_count};
  const FocalWindow window = focalWindow(distance_m, lenticular.fov_y_rad, layout.aspect, defaults);
  layout.views = {{cameraThroughWindow(window, glm::dvec3(0.0), layout.tile_size_px)}};
  // Distance between neighbouring nearest views; without such views, between those of neighbouring
  // subpixels.
  const double width_m = 2 * distance_m * std::tan(lenticular.view_cone_rad / 2);
  const double lens_share =
      std::abs(lensCount(*lenticular.calibration)) / (3.0 * layout.size_px.width);
  layout.view_pitch_m.x =
      width_m * (lenticular.view_count > 0 ? 1.0 / lenticular.view_count : lens_share);
}

}  // namespace viewloom
