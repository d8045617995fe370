// SPDX-License-Identifier: Apache-2.0
#include "display/cameras.h"

#include <cmath>

#include "base/str_cat.h"
#include "display/atlas_layout.h"
#include "display/focal_window.h"

namespace viewloom {
namespace {

uint32_t viewCount(const CamerasSpec& cameras) {
  return cameras.grid ? cameras.grid->count() : static_cast<uint32_t>(cameras.cameras.size());
}

// Default number of columns of the tiles.
uint32_t usualColumns(const CamerasSpec& cameras) {
  switch (cameras.arrangement) {
    case TileArrangement::kRow:
      return viewCount(cameras);
    case TileArrangement::kQuad:
      return 2;
    case TileArrangement::kSeparate:
      return 1;
    case TileArrangement::kGrid:
      break;
  }
  if (cameras.grid) return cameras.grid->columns;
  return static_cast<uint32_t>(std::ceil(std::sqrt(double{1} * viewCount(cameras))));
}

absl::Status completeArrangement(CamerasSpec& cameras) {
  const uint32_t columns = usualColumns(cameras);
  if (cameras.arrangement != TileArrangement::kGrid && cameras.columns != 0 &&
      cameras.columns != columns) {
    return invalidField("cameras.columns", strCat("got ", cameras.columns,
                                                  " columns; accepted for this arrangement is ",
                                                  columns, ", or leave columns out"));
  }
  if (cameras.arrangement == TileArrangement::kQuad && viewCount(cameras) != 4) {
    return invalidField("cameras.arrangement", strCat("QUAD_2X2 is given for ", viewCount(cameras),
                                                      " views; accepted is exactly 4 views"));
  }
  if (cameras.columns == 0) cameras.columns = columns;
  return absl::OkStatus();
}

}  // namespace

absl::Status takePreset(CamerasSpec&) {
  return absl::OkStatus();
}

absl::Status settle(CamerasSpec& cameras) {
  if (cameras.grid && !cameras.cameras.empty()) {
    return invalidField("cameras.grid",
                        "a grid and a list of cameras are given; accepted is one of the two");
  }
  const uint64_t count =
      cameras.grid ? uint64_t{cameras.grid->columns} * cameras.grid->rows : cameras.cameras.size();
  if (count < 1 || count > kCameraCountMax) {
    return invalidField(cameras.grid ? "cameras.grid" : "cameras.cameras",
                        strCat("got ", count, " cameras; accepted is 1..", kCameraCountMax));
  }
  return completeArrangement(cameras);
}

double* focalPlane(CamerasSpec& cameras) {
  return cameras.grid ? &cameras.grid->focal_distance_m : nullptr;
}

std::optional<OpenFov> openFov(const CamerasSpec& cameras) {
  if (!cameras.grid) return std::nullopt;
  return OpenFov{"cameras.grid.fov_y_rad", cameras.grid->fov_y_rad};
}

std::vector<KnownDevice> devicesOf(const CamerasSpec&) {
  return {};
}

TileGrid tileGrid(const CamerasSpec& cameras) {
  const uint32_t count = viewCount(cameras);
  const uint32_t rows = (count + cameras.columns - 1) / cameras.columns;
  return {.size_field = "cameras.tile_size",
          .columns = cameras.columns,
          .rows = rows,
          .tile_size_px = cameras.tile_size_px,
          .order = cameras.order,
          .view_count = count,
          .width_px = uint64_t{cameras.columns} * cameras.tile_size_px.width,
          .height_px = uint64_t{rows} * cameras.tile_size_px.height,
          .image_count = cameras.arrangement == TileArrangement::kSeparate ? count : 1};
}

std::vector<View> cameraViews(const std::vector<ViewCamera>& cameras, SizePx tile_size_px) {
  std::vector<View> views;
  views.reserve(cameras.size());
  for (const ViewCamera& camera : cameras) {
    const auto* fov = std::get_if<Fov>(&camera.projection);
    views.push_back(
        {Camera{.pose = camera.pose,
                .intrinsics = fov != nullptr ? intrinsicsFromFov(*fov, tile_size_px)
                                             : std::get<Intrinsics>(camera.projection)}});
  }
  return views;
}

void describe(const CamerasSpec& cameras, const StreamDefaults& defaults, AtlasLayout& layout) {
  if (!cameras.grid) {
    layout.views = cameraViews(cameras.cameras, cameras.tile_size_px);
    return;
  }
  const CameraGrid& grid = *cameras.grid;
  layout.focal_distance_m = focalDistance(grid.focal_distance_m, defaults);
  layout.eye_focus_m = layout.focal_distance_m;
  layout.view_pitch_m = grid.spacing_m;
  const FocalWindow window =
      focalWindow(layout.focal_distance_m, grid.fov_y_rad, layout.aspect, defaults);
  const double upwards = cameras.order == TileOrder::kBottomLeft ? 1.0 : -1.0;
  for (uint32_t view = 0; view < grid.count(); ++view) {
    const glm::dvec2 place(view % grid.columns - (grid.columns - 1) / 2.0,
                           upwards * (view / grid.columns - (grid.rows - 1) / 2.0));
    layout.views.push_back(
        {cameraThroughWindow(window, {place * grid.spacing_m, 0.0}, cameras.tile_size_px)});
  }
}

}  // namespace viewloom
