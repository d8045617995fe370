// SPDX-License-Identifier: Apache-2.0
#include "bench/display_loads.h"

#include <algorithm>
#include <utility>

#include "calibration/calibration.h"
#include "display/integral.h"
#include "display/presets.h"

namespace viewloom::bench {
namespace {

constexpr uint32_t kViewCounts[] = {8, 24, 48, 96};
constexpr const char* kPanelOfViewCounts = "portrait";

SizePx shrunk(SizePx size_px, uint32_t shrink) {
  return {std::max(1u, size_px.width / shrink), std::max(1u, size_px.height / shrink)};
}

DisplaySpec completed(DisplaySpec spec) {
  return completeDisplaySpec(std::move(spec)).value();
}

DisplaySpec quiltOf(const Preset& preset, uint32_t shrink, double cone_rad) {
  return completed({.kind = QuiltSpec{.preset = std::string(preset.name),
                                      .size_px = shrunk(preset.size_px, shrink),
                                      .view_cone_rad = cone_rad}});
}

DisplaySpec panelOf(Calibration calibration, uint32_t shrink, double cone_rad,
                    uint32_t view_count) {
  calibration.screen_px = shrunk(calibration.screen_px, shrink);
  return completed({.kind = LenticularSpec{.calibration_json = writeCalibration(calibration),
                                           .view_count = view_count,
                                           .view_cone_rad = cone_rad}});
}

}  // namespace

std::vector<DisplayLoad> displayLoads(uint32_t shrink, double cone_rad) {
  std::vector<DisplayLoad> loads;
  for (const Preset& preset : allPresets()) {
    const std::string name(preset.name);
    loads.push_back({name + " quilt", quiltOf(preset, shrink, cone_rad)});
    const std::optional<Calibration> panel = panelOfPreset(preset.name);
    if (panel) loads.push_back({name + " native", panelOf(*panel, shrink, cone_rad, 0)});
  }
  const Calibration panel = panelOfPreset(kPanelOfViewCounts).value();
  for (const uint32_t view_count : kViewCounts) {
    loads.push_back(
        {std::string(kPanelOfViewCounts) + " native, " + std::to_string(view_count) + " views",
         panelOf(panel, shrink, cone_rad, view_count)});
  }
  for (const KnownDevice& preset : devicesOf(IntegralSpec{})) {
    loads.push_back(
        {std::string(preset.name) + " elemental",
         completed({.kind = IntegralSpec{.preset = std::string(preset.name),
                                         .panel_px = shrunk(preset.panel_px, shrink)}})});
  }
  return loads;
}

}  // namespace viewloom::bench
