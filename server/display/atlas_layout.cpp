// SPDX-License-Identifier: Apache-2.0
#include "display/atlas_layout.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "base/check.h"
#include "display/camera_list.h"
#include "display/focal_window.h"
#include "display/quilt.h"
#include "display/stereo.h"

namespace viewloom {
namespace {

// Tiles and where they stand, before any stream is known.
struct TileGrid {
  const char* size_field;  // what the client would have to make smaller
  uint32_t columns;
  uint32_t rows;
  SizePx tile_size_px;
  TileOrder order;
  uint32_t view_count;
  uint64_t width_px;  // of the atlas; 64 bits: not yet known to be within limits
  uint64_t height_px;
};

TileGrid tileGrid(const QuiltSpec& quilt) {
  return {.size_field = "quilt.size",
          .columns = quilt.columns,
          .rows = quilt.rows,
          .tile_size_px = quiltTileSize(quilt),
          .order = quilt.order,
          .view_count = quilt.view_count,
          .width_px = quilt.size_px.width,
          .height_px = quilt.size_px.height};
}

TileGrid tileGrid(const StereoSpec& stereo) {
  const bool beside = stereo.layout == StereoLayout::kSideBySide;
  const uint32_t columns = beside ? 2 : 1;
  const uint32_t rows = beside ? 1 : 2;
  return {.size_field = "stereo.eye_size",
          .columns = columns,
          .rows = rows,
          .tile_size_px = stereo.eye_size_px,
          .order = TileOrder::kTopLeft,
          .view_count = 2,
          .width_px = uint64_t{columns} * stereo.eye_size_px.width,
          .height_px = uint64_t{rows} * stereo.eye_size_px.height};
}

TileGrid tileGrid(const CamerasSpec& cameras) {
  const auto count = static_cast<uint32_t>(cameras.cameras.size());
  const uint32_t rows = (count + cameras.columns - 1) / cameras.columns;
  return {.size_field = "cameras.tile_size",
          .columns = cameras.columns,
          .rows = rows,
          .tile_size_px = cameras.tile_size_px,
          .order = cameras.order,
          .view_count = count,
          .width_px = uint64_t{cameras.columns} * cameras.tile_size_px.width,
          .height_px = uint64_t{rows} * cameras.tile_size_px.height};
}

TileGrid tileGridOf(const DisplaySpec& spec) {
  return std::visit([](const auto& kind) { return tileGrid(kind); }, spec.kind);
}

bool isUsable(const Intrinsics& intrinsics) {
  for (int axis = 0; axis < 2; ++axis) {
    const double focal_px = intrinsics.focal_px[axis];
    if (!std::isfinite(focal_px) || focal_px <= 0) return false;
    if (!std::isfinite(intrinsics.principal_px[axis])) return false;
  }
  return true;
}

void describe(const QuiltSpec& quilt, const StreamDefaults& defaults, AtlasLayout& layout) {
  layout.aspect = quiltAspect(quilt);
  layout.view_cone_rad = quilt.view_cone_rad;
  layout.focal_distance_m = focalDistance(quilt.focal_distance_m, defaults);
  layout.suffix = absl::StrFormat("_qs%ux%ua%g", quilt.columns, quilt.rows, layout.aspect);
  layout.views = quiltViews(quilt, defaults);
}

void describe(const StereoSpec& stereo, const StreamDefaults& defaults, AtlasLayout& layout) {
  layout.focal_distance_m = focalDistance(stereo.focal_distance_m, defaults);
  layout.views = stereoViews(stereo, defaults);
}

void describe(const CamerasSpec& cameras, const StreamDefaults&, AtlasLayout& layout) {
  layout.views = cameraViews(cameras.cameras, cameras.tile_size_px);
}

}  // namespace

TileOrigin AtlasLayout::tileOrigin(uint32_t view) const {
  VIEWLOOM_DCHECK(view < views.size());
  const uint32_t row = view / columns;
  const uint32_t row_from_top = order == TileOrder::kTopLeft ? row : rows - 1 - row;
  return {.x_px = view % columns * tile_size_px.width,
          .y_px = padding_top_px + row_from_top * tile_size_px.height};
}

uint32_t AtlasLayout::viewAt(uint32_t column, uint32_t row_from_top) const {
  const auto none = static_cast<uint32_t>(views.size());
  if (column >= columns || row_from_top >= rows) return none;
  const uint32_t row = order == TileOrder::kTopLeft ? row_from_top : rows - 1 - row_from_top;
  return std::min(row * columns + column, none);
}

double contentFocalDistance(const SourceStats& stats) {
  const double mean_inv_z = (stats.inv_z_near + stats.inv_z_far) / 2;
  return mean_inv_z > 0 ? 1 / mean_inv_z : StreamDefaults{}.focal_distance_m;
}

absl::StatusOr<AtlasLayout> makeAtlasLayout(const DisplaySpec& spec,
                                            const StreamDefaults& defaults) {
  const TileGrid grid = tileGridOf(spec);
  AtlasLayout layout;
  layout.size_px = {static_cast<uint32_t>(grid.width_px), static_cast<uint32_t>(grid.height_px)};
  layout.columns = grid.columns;
  layout.rows = grid.rows;
  layout.tile_size_px = grid.tile_size_px;
  layout.order = grid.order;
  layout.aspect = double{1} * grid.tile_size_px.width / grid.tile_size_px.height;
  layout.padding_right_px = layout.size_px.width - grid.columns * grid.tile_size_px.width;
  layout.padding_top_px = layout.size_px.height - grid.rows * grid.tile_size_px.height;
  std::visit([&](const auto& kind) { describe(kind, defaults, layout); }, spec.kind);
  for (const View& view : layout.views) {
    if (isUsable(view.camera.intrinsics)) continue;
    return fieldError(absl::StatusCode::kFailedPrecondition, grid.size_field,
                      "the stream's camera and this display give no finite view");
  }
  return layout;
}

absl::Status validateAtlasLimits(const DisplaySpec& spec, const AtlasLimits& limits) {
  const TileGrid grid = tileGridOf(spec);
  const auto refuse = [&](std::string_view problem) {
    return fieldError(absl::StatusCode::kResourceExhausted, grid.size_field, problem);
  };
  if (std::max(grid.width_px, grid.height_px) > limits.side_px_max) {
    return refuse(absl::StrCat("the atlas has ", grid.width_px, "x", grid.height_px,
                               " px, accepted is a side of up to ", limits.side_px_max));
  }
  if (grid.width_px * grid.height_px > limits.area_px_max) {
    return refuse(absl::StrCat("the atlas has ", grid.width_px * grid.height_px,
                               " px, accepted is up to ", limits.area_px_max));
  }
  if (grid.view_count > limits.view_count_max) {
    return refuse(absl::StrCat("the atlas has ", grid.view_count, " views, accepted is up to ",
                               limits.view_count_max));
  }
  return absl::OkStatus();
}

uint32_t bandRowCount(const EncodingSpec& encoding) {
  constexpr uint32_t kMcuRows = 8;  // RST0..RST7
  const bool fine = encoding.color == BandEncoding::kJpeg && encoding.chroma == Chroma::k444;
  return kMcuRows * (fine ? 8 : 16);
}

}  // namespace viewloom
