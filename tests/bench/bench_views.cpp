// SPDX-License-Identifier: Apache-2.0
#include "bench/bench_views.h"

#include <cmath>
#include <numbers>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "base/check.h"
#include "display/focal_window.h"
#include "display/presets.h"

namespace viewloom::bench {
namespace {

StreamDefaults defaultsOf(const SourceView& source) {
  return {.source_intrinsics = source.camera.intrinsics,
          .source_size_px = source.size_px,
          .focal_distance_m = contentFocalDistance(source.stats)};
}

// How far aside an eye stands that sees the nearest surface moved by this.
double eyeOffset(const SourceView& source, double span_px) {
  return span_px / (source.camera.intrinsics.focal_px.x * source.stats.inv_z_max);
}

// Off-axis, onto what the source sees at the focal distance. Camera space: x right, y up.
View viewThroughWindow(const SourceView& source, const glm::dvec2& eye_m, SizePx tile_px) {
  const StreamDefaults defaults = defaultsOf(source);
  FocalWindow window =
      focalWindow(defaults.focal_distance_m, 0, double(tile_px.width) / tile_px.height, defaults);
  window.center_m.y -= eye_m.y;
  View view{cameraThroughWindow(window, eye_m.x, tile_px)};
  view.camera.pose.position_m.y = eye_m.y;
  return view;
}

AtlasLayout emptyGrid(uint32_t columns, uint32_t rows, SizePx tile_px) {
  AtlasLayout layout;
  layout.columns = columns;
  layout.rows = rows;
  layout.tile_size_px = tile_px;
  layout.size_px = {columns * tile_px.width, rows * tile_px.height};
  return layout;
}

// From -1 to 1, ends included.
double placeOf(uint32_t i, uint32_t count) {
  return count < 2 ? 1 : 2.0 * i / (count - 1) - 1;
}

AtlasLayout rowOfEyes(const SourceView& source, AtlasLayout grid, double span_px) {
  const uint32_t count = grid.columns * grid.rows;
  const double offset_m = eyeOffset(source, span_px);
  for (uint32_t i = 0; i < count; ++i) {
    grid.views.push_back(
        viewThroughWindow(source, {offset_m * placeOf(i, count), 0}, grid.tile_size_px));
  }
  return grid;
}

}  // namespace

AtlasLayout quiltOfSpan(const SourceView& source, std::string_view preset_name, double span_px) {
  const Preset* const preset = findPreset(preset_name);
  VIEWLOOM_CHECK(preset != nullptr);
  const SizePx tile_px{preset->size_px.width / preset->columns,
                       preset->size_px.height / preset->rows};
  return rowOfEyes(source, emptyGrid(preset->columns, preset->rows, tile_px), span_px);
}

AtlasLayout gridOfSpan(const SourceView& source, uint32_t side, double span_px) {
  AtlasLayout layout = emptyGrid(side, side, {420, 420});
  const double offset_m = eyeOffset(source, span_px) / std::numbers::sqrt2;
  for (uint32_t row = 0; row < side; ++row) {
    for (uint32_t column = 0; column < side; ++column) {
      layout.views.push_back(viewThroughWindow(
          source, {offset_m * placeOf(column, side), -offset_m * placeOf(row, side)},
          layout.tile_size_px));
    }
  }
  return layout;
}

AtlasLayout steppingCamera(const SourceView& source, double span_px) {
  constexpr double kYaw_rad = 0.06;
  constexpr double kPitch_rad = 0.04;
  constexpr double kRoll_rad = 0.1;
  const double offset_m = eyeOffset(source, span_px);
  AtlasLayout layout = emptyGrid(1, 1, source.size_px);
  View& view = layout.views.emplace_back();
  view.camera.intrinsics = source.camera.intrinsics;
  view.camera.pose.position_m = {0.8 * offset_m, 0.4 * offset_m, -0.5 * offset_m};
  view.camera.pose.orientation = glm::dquat(glm::dvec3(kPitch_rad, kYaw_rad, kRoll_rad));
  return layout;
}

AtlasLayout viewsOfSharedArea(const SourceView& source, uint32_t view_count, double span_px) {
  // 8 columns of 420 px; all rows together are 3360 px high.
  constexpr uint32_t kColumns = 8;
  const uint32_t rows = view_count / kColumns;
  return rowOfEyes(source, emptyGrid(kColumns, rows, {420, 3360 / rows}), span_px);
}

}  // namespace viewloom::bench
