// SPDX-License-Identifier: Apache-2.0
#include "bench/bench_views.h"

#include <algorithm>
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
  const FocalWindow window =
      focalWindow(defaults.focal_distance_m, 0, double(tile_px.width) / tile_px.height, defaults);
  return {cameraThroughWindow(window, {eye_m, 0.0}, tile_px)};
}

AtlasLayout emptyGrid(const SourceView& source, uint32_t columns, uint32_t rows, SizePx tile_px) {
  AtlasLayout layout;
  layout.columns = columns;
  layout.rows = rows;
  layout.tile_size_px = {std::max(tile_px.width / source.miniature, 1U),
                         std::max(tile_px.height / source.miniature, 1U)};
  layout.size_px = {columns * layout.tile_size_px.width, rows * layout.tile_size_px.height};
  return layout;
}

// The source's own pinhole, onto a tile that may be smaller.
Intrinsics pinholeOf(const SourceView& source, SizePx tile_px) {
  const glm::dvec2 scale = glm::dvec2(tile_px.width, tile_px.height) /
                           glm::dvec2(source.size_px.width, source.size_px.height);
  return {source.camera.intrinsics.focal_px * scale, source.camera.intrinsics.principal_px * scale};
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
  return rowOfEyes(source, emptyGrid(source, preset->columns, preset->rows, tile_px), span_px);
}

AtlasLayout gridOfSpan(const SourceView& source, uint32_t side, double span_px) {
  AtlasLayout layout = emptyGrid(source, side, side, {420, 420});
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

AtlasLayout rotatedView(const SourceView& source, double span_px) {
  constexpr double kYaw_rad = 0.06;
  constexpr double kPitch_rad = 0.04;
  constexpr double kRoll_rad = 0.1;
  const double offset_m = eyeOffset(source, span_px);
  AtlasLayout layout = emptyGrid(
      source, 1, 1,
      {source.size_px.width * source.miniature, source.size_px.height * source.miniature});
  View& view = layout.views.emplace_back();
  view.camera.intrinsics = pinholeOf(source, layout.tile_size_px);
  view.camera.pose.position_m = {0.8 * offset_m, 0.4 * offset_m, -0.5 * offset_m};
  view.camera.pose.orientation = glm::dquat(glm::dvec3(kPitch_rad, kYaw_rad, kRoll_rad));
  return layout;
}

AtlasLayout steppingCamera(const SourceView& source, double span_px) {
  constexpr uint32_t kColumns = 8;
  constexpr uint32_t kRows = 2;
  constexpr uint32_t kReduced = 3;
  constexpr double kYaw_rad = 0.06;
  constexpr double kPitch_rad = 0.03;
  constexpr double kRoll_rad = 0.08;
  const double offset_m = eyeOffset(source, span_px);
  AtlasLayout layout = emptyGrid(source, kColumns, kRows,
                                 {source.size_px.width * source.miniature / kReduced,
                                  source.size_px.height * source.miniature / kReduced});
  for (uint32_t i = 0; i < kColumns * kRows; ++i) {
    const double place = placeOf(i, kColumns * kRows);
    View& view = layout.views.emplace_back();
    view.camera.intrinsics = pinholeOf(source, layout.tile_size_px);
    // Turned towards what it looked at from the middle.
    view.camera.pose.position_m =
        offset_m * glm::dvec3(0.9 * place, 0.4 * place, -0.3 - 0.3 * place);
    view.camera.pose.orientation =
        glm::dquat(glm::dvec3(kPitch_rad * place, kYaw_rad * place, kRoll_rad * place));
  }
  return layout;
}

AtlasLayout viewsOfSharedArea(const SourceView& source, uint32_t view_count, double span_px) {
  // 8 columns of 420 px; all rows together are 3360 px high.
  constexpr uint32_t kColumns = 8;
  const uint32_t rows = view_count / kColumns;
  return rowOfEyes(source, emptyGrid(source, kColumns, rows, {420, 3360 / rows}), span_px);
}

}  // namespace viewloom::bench
