// SPDX-License-Identifier: Apache-2.0
#include "display/stereo.h"

#include <glm/common.hpp>

#include "base/str_cat.h"
#include "display/atlas_layout.h"
#include "display/cameras.h"
#include "display/focal_window.h"

namespace viewloom {

namespace {

constexpr double kDefaultEyeDistance_m = 0.063;

}  // namespace

absl::Status takePreset(StereoSpec&) {
  return absl::OkStatus();
}

absl::Status settle(StereoSpec& stereo) {
  if (stereo.eye_distance_m == 0) stereo.eye_distance_m = kDefaultEyeDistance_m;
  const uint32_t count = eyeCount(stereo);
  if (!stereo.eyes.empty() && stereo.eyes.size() != count) {
    return invalidField("stereo.eyes", strCat("got ", stereo.eyes.size(),
                                              " eyes; with this layout, accepted is none or ",
                                              count == 1 ? "one" : "two: left, right"));
  }
  if (stereo.is_tracked && !stereo.eyes.empty()) {
    return invalidField("stereo.eyes",
                        "eyes are given although tracked is set; accepted is one of the two");
  }
  return absl::OkStatus();
}

double* focalPlane(StereoSpec& stereo) {
  return stereo.is_tracked || !stereo.eyes.empty() ? nullptr : &stereo.focal_distance_m;
}

std::optional<OpenFov> openFov(const StereoSpec& stereo) {
  if (!stereo.eyes.empty()) return std::nullopt;
  return OpenFov{"stereo.fov_y_rad", stereo.fov_y_rad};
}

std::vector<KnownDevice> devicesOf(const StereoSpec&) {
  return {};
}

TileGrid tileGrid(const StereoSpec& stereo) {
  const uint32_t count = eyeCount(stereo);
  const uint32_t columns = stereo.layout == StereoLayout::kSideBySide ? count : 1;
  const uint32_t rows = count / columns;
  return {.size_field = "stereo.eye_size",
          .columns = columns,
          .rows = rows,
          .tile_size_px = stereo.eye_size_px,
          .order = TileOrder::kTopLeft,
          .view_count = count,
          .width_px = uint64_t{columns} * stereo.eye_size_px.width,
          .height_px = uint64_t{rows} * stereo.eye_size_px.height,
          .image_count = stereo.layout == StereoLayout::kSeparate ? 2u : 1u};
}

void describe(const StereoSpec& stereo, const StreamDefaults& defaults, AtlasLayout& layout) {
  layout.focal_distance_m = focalDistance(stereo.focal_distance_m, defaults);
  layout.eye_focus_m = layout.focal_distance_m;
  if (eyeCount(stereo) == 2) layout.view_pitch_m.x = stereo.eye_distance_m;
  if (!stereo.eyes.empty()) {
    layout.views = cameraViews(stereo.eyes, stereo.eye_size_px);
    if (stereo.eyes.size() == 1) return;
    const glm::dvec3 beside_m = stereo.eyes[1].pose.position_m - stereo.eyes[0].pose.position_m;
    layout.view_pitch_m = glm::abs(glm::dvec2(beside_m));
    return;
  }
  const double aspect = double{1} * stereo.eye_size_px.width / stereo.eye_size_px.height;
  const FocalWindow window =
      focalWindow(layout.focal_distance_m, stereo.fov_y_rad, aspect, defaults);
  const std::vector<double> sides =
      eyeCount(stereo) == 1 ? std::vector{0.0} : std::vector{-0.5, 0.5};
  for (const double side : sides) {
    layout.views.push_back(
        {cameraThroughWindow(window, {side * stereo.eye_distance_m, 0, 0}, stereo.eye_size_px)});
  }
}

}  // namespace viewloom
