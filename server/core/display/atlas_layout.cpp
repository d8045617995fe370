// SPDX-License-Identifier: Apache-2.0
#include "display/atlas_layout.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/str_cat.h"
#include "display/tracked_eyes.h"

namespace viewloom {
namespace {

// A lens has at least as many samples as it has points to be walked through. Without a filter they
// are spread over the px alone, so that what is in focus has no stairs.
absl::Status addSamples(const DisplaySpec& spec, const StreamDefaults& defaults,
                        AtlasLayout& layout) {
  RayFilter filter = spec.filter;
  if (spec.lens) {
    const auto lens = lensRays(*spec.lens, layout, defaults);
    VIEWLOOM_RETURN_IF_ERROR(lens.status());
    layout.lens = *lens;
  }
  if (layout.lens) {
    if (filter.sample_count == 1) filter.width = 0;
    filter.sample_count = std::max(filter.sample_count, layout.lens->walked_count);
    layout.lens->walked_count = filter.sample_count;
    layout.lens_points = lensPoints(*layout.lens);
  }
  const bool has_channels = std::holds_alternative<LenticularRays>(layout.rays);
  layout.samples = has_channels ? channelSamples(filter, layout.view_pitch_m)
                                : filterSamples(filter, layout.view_pitch_m);
  return absl::OkStatus();
}

bool isUsable(const Intrinsics& intrinsics) {
  for (int axis = 0; axis < 2; ++axis) {
    const double focal_px = intrinsics.focal_px[axis];
    if (!std::isfinite(focal_px) || focal_px <= 0) return false;
    if (!std::isfinite(intrinsics.principal_px[axis])) return false;
  }
  return true;
}

}  // namespace

abi::DepthScale scaleOf(const DepthCodes& codes) {
  const double zero = codes.is_black_near ? codes.inv_z_near : codes.inv_z_far;
  const double full = codes.is_black_near ? codes.inv_z_far : codes.inv_z_near;
  return {.inv_z_of_zero = float(zero),
          .codes_per_inv_z = float(codes.codeMax() / (full - zero)),
          .code_max = float(codes.codeMax())};
}

TileArrangementPx AtlasLayout::shown() const {
  if (stack) return unstacked;
  return {.size_px = size_px,
          .columns = columns,
          .rows = rows,
          .tile_size_px = tile_size_px,
          .order = order,
          .padding_right_px = padding_right_px,
          .padding_top_px = padding_top_px,
          .image_count = image_count};
}

TileOrigin AtlasLayout::tileOrigin(uint32_t view) const {
  VIEWLOOM_DCHECK(view < views.size());
  if (order == TileOrder::kStacked) {
    const StackCell cell = stack->cellOf(view);
    return {.x_px = cell.column * tile_size_px.width,
            .y_px = (cell.picture * stack->rows + cell.row) * tile_size_px.height};
  }
  const uint32_t row = view / columns;
  const uint32_t row_from_top = order == TileOrder::kTopLeft ? row : rows - 1 - row;
  return {.x_px = view % columns * tile_size_px.width,
          .y_px = padding_top_px + row_from_top * tile_size_px.height};
}

double AtlasLayout::distanceOf(double plane_m, const View& view) const {
  const double distance_m = plane_m + view.camera.pose.position_m.z;
  return distance_m > 0 ? distance_m : kNoFocus_m;
}

uint32_t AtlasLayout::viewAt(uint32_t column, uint32_t row_from_top) const {
  const auto none = static_cast<uint32_t>(views.size());
  if (column >= columns || row_from_top >= rows) return none;
  if (order == TileOrder::kStacked) {
    return stack->viewAt({.picture = row_from_top / stack->rows,
                          .column = column,
                          .row = row_from_top % stack->rows});
  }
  const uint32_t row = order == TileOrder::kTopLeft ? row_from_top : rows - 1 - row_from_top;
  return std::min(row * columns + column, none);
}

double contentFocalDistance(const SourceStats& stats) {
  // Percentiles lie somewhere in bins of a 32nd of an octave, which are wider than what is flat.
  const double mean_inv_z =
      std::clamp((stats.inv_z_near + stats.inv_z_far) / 2, stats.inv_z_min, stats.inv_z_max);
  return mean_inv_z > 0 ? 1 / mean_inv_z : StreamDefaults{}.focal_distance_m;
}

StreamDefaults streamDefaults(const Intrinsics& intrinsics, SizePx size_px,
                              const SourceStats& stats) {
  return {.source_intrinsics = intrinsics,
          .source_size_px = size_px,
          .focal_distance_m = contentFocalDistance(stats),
          .inv_z_near = stats.inv_z_near,
          .inv_z_far = stats.inv_z_far};
}

absl::StatusOr<AtlasLayout> makeAtlasLayout(const DisplaySpec& spec, const StreamDefaults& defaults,
                                            const EyePoses* eyes) {
  const TileGrid grid = tileGridOf(spec);
  AtlasLayout layout;
  layout.size_px = {static_cast<uint32_t>(grid.width_px), static_cast<uint32_t>(grid.height_px)};
  layout.columns = grid.columns;
  layout.rows = grid.rows;
  layout.tile_size_px = grid.tile_size_px;
  layout.order = grid.order;
  layout.image_count = grid.image_count;
  layout.aspect = double{1} * grid.tile_size_px.width / grid.tile_size_px.height;
  layout.padding_right_px = layout.size_px.width - grid.columns * grid.tile_size_px.width;
  layout.padding_top_px = layout.size_px.height - grid.rows * grid.tile_size_px.height;
  std::visit([&](const auto& kind) { describe(kind, defaults, layout); }, spec.kind);
  if (eyes != nullptr) {
    VIEWLOOM_CHECK(isTracked(spec));
    VIEWLOOM_RETURN_IF_ERROR(placeEyes(*eyes, std::get<StereoSpec>(spec.kind), defaults, layout));
  }
  if (layout.depth_codes) VIEWLOOM_RETURN_IF_ERROR(validateDepthCodes(*layout.depth_codes));
  VIEWLOOM_RETURN_IF_ERROR(addSamples(spec, defaults, layout));
  for (const View& view : layout.views) {
    if (isUsable(view.camera.intrinsics)) continue;
    return fieldError(
        absl::StatusCode::kFailedPrecondition, grid.size_field,
        "the camera of the stream and this display give no finite view; give the display "
        "a field of view, or a focal distance");
  }
  return layout;
}

absl::Status stackViews(AtlasLayout& layout) {
  VIEWLOOM_CHECK(!layout.stack && std::holds_alternative<PinholeRays>(layout.rays));
  const absl::StatusOr<VideoStack> planned =
      planVideoStack(layout.tile_size_px, uint32_t(layout.views.size()));
  VIEWLOOM_RETURN_IF_ERROR(planned.status());
  const SizePx picture_px = planned->pictureSize();
  layout.unstacked = layout.shown();
  layout.stack = *planned;
  layout.size_px = {picture_px.width, picture_px.height * planned->picture_count};
  layout.columns = planned->columns;
  layout.rows = planned->rows * planned->picture_count;
  layout.tile_size_px = planned->cell_px;
  layout.order = TileOrder::kStacked;
  layout.padding_right_px = 0;
  layout.padding_top_px = 0;
  layout.image_count = planned->picture_count;
  return absl::OkStatus();
}

TileGrid tileGridOf(const DisplaySpec& spec) {
  return std::visit([](const auto& kind) { return tileGrid(kind); }, spec.kind);
}

int64_t rayCount(const DisplaySpec& spec) {
  const TileGrid grid = tileGridOf(spec);
  const uint32_t of_lens = spec.lens ? spec.lens->walked_count : 1;
  return int64_t(grid.width_px * grid.height_px * grid.rays_per_px) *
         std::max(spec.filter.sample_count, of_lens);
}

absl::Status validateAtlasLimits(const DisplaySpec& spec, const AtlasLimits& limits) {
  const TileGrid grid = tileGridOf(spec);
  const auto refuse = [&](std::string_view problem) {
    return fieldError(absl::StatusCode::kResourceExhausted, grid.size_field, problem);
  };
  if (std::max(grid.width_px, grid.height_px) > limits.side_px_max) {
    return refuse(strCat("the atlas has ", grid.width_px, "x", grid.height_px,
                         " px; accepted is up to ", limits.side_px_max, " px a side"));
  }
  if (grid.width_px * grid.height_px > limits.area_px_max) {
    return refuse(strCat("the atlas has ", grid.width_px * grid.height_px,
                         " px; accepted is up to ", limits.area_px_max, " px"));
  }
  if (grid.view_count > limits.view_count_max) {
    return refuse(strCat("the atlas has ", grid.view_count, " views; accepted is up to ",
                         limits.view_count_max));
  }
  return absl::OkStatus();
}

uint32_t bandRowCount(const EncodingSpec& encoding) {
  constexpr uint32_t kMcuRows = 8;  // RST0..RST7
  const bool fine = encoding.color == BandEncoding::kJpegPlanes ||
                    (encoding.color == BandEncoding::kJpeg && encoding.chroma == Chroma::k444);
  return kMcuRows * (fine ? 8 : 16);
}

}  // namespace viewloom
