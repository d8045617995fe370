// SPDX-License-Identifier: Apache-2.0
#include "sweep/view_sweeper.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "sweep/color_kernels.h"
#include "sweep/describe_swept.h"
#include "sweep/edge_blends.h"

namespace viewloom {
namespace {

// 0xRRGGBB as the atlas has it.
uint32_t redFirst(uint32_t rgb) {
  return (rgb >> 16 & 0xff) | (rgb & 0xff00) | (rgb & 0xff) << 16 | kOpaqueBlack;
}

// The first px of a row of a tile.
size_t firstPixel(const AtlasLayout& layout, uint32_t tile, uint32_t tile_row) {
  const size_t row =
      layout.padding_top_px + size_t{tile / layout.columns} * layout.tile_size_px.height + tile_row;
  return row * layout.size_px.width + size_t{tile % layout.columns} * layout.tile_size_px.width;
}

// How far mixed texels give way, as far as the view moves the nearest against the furthest, px of
// the source: see cleanShare in shaders/lib/light/ray_light.glsl.
float cleanShare(const SweepPicture& picture, const SweepView& view, uint32_t width_px) {
  const float eye_px_m = view.eyeAt(0.5F * float(width_px - 1));
  return std::min(std::abs(eye_px_m) * picture.source.steps.inv_z_range, 1.0F);
}

// Rows of the atlas whose unused px are cleared with these rows of the plan and of the grid of
// tiles: as many with each.
BandRows clearedWith(const SweepPicture& picture, uint32_t first_row, uint32_t row_count,
                     GridRows grid) {
  const AtlasLayout& layout = *picture.job->layout;
  const auto gridRow = [&](uint32_t row) {
    if (row == layout.rows) return layout.size_px.height;
    return row == 0 ? 0 : layout.padding_top_px + row * layout.tile_size_px.height;
  };
  const uint64_t height_px = gridRow(grid.end) - gridRow(grid.first);
  const auto atlasRow = [&](uint64_t row) {
    return gridRow(grid.first) + uint32_t(row * height_px / picture.plan->rowCount());
  };
  const uint32_t first = atlasRow(first_row);
  return {first, atlasRow(first_row + row_count) - first};
}

}  // namespace

// Writes codes that are rounded already.
void writeLinear(const uint32_t* rgba, uint32_t width_px, float* linear) {
  for (size_t i = 0; i < size_t{width_px} * 4; ++i) {
    linear[i] = float(rgba[i / 4] >> (8 * (i % 4)) & 0xff) / 255;
  }
}

// Depth as grey. `view_z`: Z in the source for a metre along the view's axis.
void writeGreys(const AlignedArray<float>& inv_z, float view_z, const abi::DepthScale& scale,
                uint32_t width_px, uint32_t* rgba) {
  for (uint32_t p = 0; p < width_px; ++p) {
    const uint32_t code = abi::depthCode(std::max(inv_z[p], 0.0F) * view_z, scale);
    rgba[p] = code * 0x010101 | kOpaqueBlack;
  }
}

// Rows of an atlas on their way.
struct ViewSweeper::Piece {
  const SweepPicture& picture;
  const TraceOutputs& outputs;
  const SweepFill fill;
  const abi::DepthScale depth_scale;
  SweptAtlas& atlas;
  Coverage coverage;
};

// Colours the px of the pieces that are not coloured yet.
void ViewSweeper::colorLenses(const Piece& piece, const SurfaceRow& row,
                              std::span<const LensPiece> lenses, uint32_t channel_mask,
                              uint32_t* panel_row) {
  sampled_.resize(lens_texels_.size());
  colorRow(row.texels.data(), row.texel_count, lens_texels_.data(), lens_texels_.size(),
           piece.fill.background, sampled_.data());
  lens_texels_.clear();
  const uint32_t* color = sampled_.data();
  for (const LensPiece& lens : lenses) {
    for (uint32_t p = 0; p < lens.count; ++p) {
      panel_row[lens.first_px + p * lens.stride_px] |= *color++ & channel_mask;
    }
  }
}

// A row of a lenticular panel. What else than colour is wanted is that of the first sample.
void ViewSweeper::sweepLenses(Piece& piece, uint32_t index) {
  const SweepPlan& plan = *piece.picture.plan;
  const TraceJob& job = *piece.picture.job;
  const size_t first_px = size_t{index} * job.layout->size_px.width;
  const SweptTiles& group = plan.groupOf(index);
  const double y_px = group.first_px + group.step_px * index;
  SurfaceRow& row = builder_.build(piece.picture.source, y_px, group.tolerance, group.px_per_inv_z);
  row_.reserve(job.layout->size_px.width, row.pieceCountMax());
  uint32_t* const panel_row = piece.atlas.color.data() + first_px;
  std::fill_n(panel_row, job.layout->size_px.width, kOpaqueBlack);
  for (uint32_t sample = 0; sample < plan.sampleCount(); ++sample) {
    const uint32_t channel_mask = 0xffU << (8 * plan.lensPieces()->channelOf(sample));
    lens_pieces_.clear();
    plan.lensPieces()->appendRow(index, sample, lens_pieces_);
    // Few at a time are dear to colour: as many as texels stay the same for.
    const std::span<const LensPiece> lenses(lens_pieces_);
    size_t colored_count = 0;
    for (size_t i = 0; i < lenses.size(); ++i) {
      const LensPiece& lens = lenses[i];
      const float clean = cleanShare(piece.picture, lens.view, lens.count);
      if (clean != row.clean) {
        colorLenses(piece, row, lenses.subspan(colored_count, i - colored_count), channel_mask,
                    panel_row);
        colored_count = i;
        row.cleanMixedTexels(clean);
      }
      paintRow(row, lens.view, piece.fill, lens.count, row_, piece.coverage);
      lens_texels_.insert(lens_texels_.end(), row_.texel.data(), row_.texel.data() + lens.count);
      if (sample > 0 || piece.outputs.wantsOnlyColor()) continue;
      describeSwept({.row = row,
                     .view = lens.view,
                     .fill = piece.fill,
                     .swept = row_,
                     .y_px = y_px,
                     .view_z = job.tiles.front().direction.z,
                     .width_px = lens.count,
                     .stride_px = lens.stride_px},
                    first_px + lens.first_px, piece.outputs, piece.atlas);
    }
    colorLenses(piece, row, lenses.subspan(colored_count), channel_mask, panel_row);
  }
  if (piece.outputs.linear) {
    writeLinear(panel_row, job.layout->size_px.width, piece.atlas.linear.data() + 4 * first_px);
  }
}

// Paints the tiles of a row of the plan for which takes(tile) is true, each coloured at
// rowOf(tile).
template <typename Takes, typename RowOf>
void ViewSweeper::sweepRow(Piece& piece, uint32_t index, const Takes& takes, const RowOf& rowOf) {
  const SweepPlan& plan = *piece.picture.plan;
  if (plan.lensPieces() != nullptr) return sweepLenses(piece, index);
  if (plan.sampleCount() == 1) return sweepSample(piece, index, 0, takes, rowOf);
  const std::vector<uint32_t>& tiles = plan.groupOf(index).tiles;
  const uint32_t width_px = piece.picture.job->layout->tile_size_px.width;
  sums_.begin(uint32_t(tiles.size()), width_px);
  sampled_.resize(tiles.size() * width_px);
  const auto sampledRow = [&](uint32_t tile, uint32_t) {
    const auto rank = std::lower_bound(tiles.begin(), tiles.end(), tile) - tiles.begin();
    return sampled_.data() + size_t(rank) * width_px;
  };
  for (uint32_t sample = 0; sample < plan.sampleCount(); ++sample) {
    sweepSample(piece, index, sample, takes, sampledRow);
    for (uint32_t rank = 0; rank < tiles.size(); ++rank) {
      if (takes(tiles[rank])) sums_.add(rank, sampledRow(tiles[rank], 0));
    }
  }
  for (uint32_t rank = 0; rank < tiles.size(); ++rank) {
    if (!takes(tiles[rank])) continue;
    uint32_t* const rgba = rowOf(tiles[rank], plan.tileRow(index));
    sums_.mean(rank, plan.sampleCount(), rgba);
    if (!piece.outputs.linear) continue;
    const size_t first = firstPixel(*piece.picture.job->layout, tiles[rank], plan.tileRow(index));
    writeLinear(rgba, width_px, piece.atlas.linear.data() + 4 * first);
  }
}

// The same of one of the samples of each px. What else than colour is wanted is that of the first.
template <typename Takes, typename RowOf>
void ViewSweeper::sweepSample(Piece& piece, uint32_t index, uint32_t sample, const Takes& takes,
                              const RowOf& rowOf) {
  const SweepPlan& plan = *piece.picture.plan;
  const TraceJob& job = *piece.picture.job;
  const uint32_t width_px = job.layout->tile_size_px.width;
  const SweptTiles& group = plan.groupOf(index, sample);
  const uint32_t tile_row = plan.tileRow(index);
  const double y_px = group.first_px + group.step_px * tile_row;
  SurfaceRow& row = builder_.build(piece.picture.source, y_px, group.tolerance, group.px_per_inv_z);
  row_.reserve(width_px, row.pieceCountMax());
  for (const uint32_t tile : group.tiles) {
    if (!takes(tile)) continue;
    const SweepView view = plan.viewOf(tile, sample);
    uint32_t* const rgba = rowOf(tile, tile_row);
    row.cleanMixedTexels(cleanShare(piece.picture, view, width_px));
    paintRow(row, view, piece.fill, width_px, row_, piece.coverage);
    const float view_z = job.tiles[tile].direction.z;
    const bool shows_depth = (job.tiles[tile].shows & abi::kShowsDepth) != 0;
    if (shows_depth) {
      writeGreys(row_.inv_z, view_z, piece.depth_scale, width_px, rgba);
    } else {
      colorRow(row.texels.data(), row.texel_count, row_.texel.data(), width_px,
               piece.fill.background, rgba);
      findEdgeBlends(row, view, width_px, row_);
      applyEdgeBlends(row_.blends, rgba);
    }
    if (sample > 0 || piece.outputs.wantsOnlyColor()) continue;
    const size_t first = firstPixel(*job.layout, tile, tile_row);
    describeSwept({.row = row,
                   .view = view,
                   .fill = piece.fill,
                   .swept = row_,
                   .y_px = y_px,
                   .view_z = view_z,
                   .width_px = width_px},
                  first, piece.outputs, piece.atlas);
    if (shows_depth && piece.outputs.linear) {
      writeLinear(rgba, width_px, piece.atlas.linear.data() + 4 * first);
    }
  }
}

Coverage ViewSweeper::sweepRows(const SweepPicture& picture, uint32_t first_row, uint32_t row_count,
                                GridRows grid, const TraceOutputs& outputs, SweptAtlas& atlas) {
  const TraceJob& job = *picture.job;
  Piece piece = {.picture = picture,
                 .outputs = outputs,
                 .fill = {.fills_border = job.outside_fill == OutsideFill::kBorder,
                          .background = redFirst(job.background_rgb),
                          .inv_z_max = picture.inv_z_max,
                          .planted_fault = picture.source.planted_fault},
                 .depth_scale = scaleOf(job.layout->depth_codes.value_or(DepthCodes{})),
                 .atlas = atlas,
                 .coverage = {}};
  VIEWLOOM_CHECK(picture.plan->colorForm(outputs.color) == outputs.color);
  atlas.clearUnused(job, outputs, clearedWith(picture, first_row, row_count, grid));
  builder_.begin(picture.source, picture.plan->colorReach());
  if (outputs.color == ColorForm::kRgba) {
    for (uint32_t index = first_row; index < first_row + row_count; ++index) {
      sweepRow(
          piece, index,
          [&](uint32_t tile) {
            const uint32_t grid_row = tile / job.layout->columns;
            return grid.first <= grid_row && grid_row < grid.end;
          },
          [&](uint32_t tile, uint32_t tile_row) {
            return atlas.color.data() + firstPixel(*job.layout, tile, tile_row);
          });
    }
    return piece.coverage;
  }
  ycbcr_rows_.begin(*job.layout, outputs.color, first_row, row_count, grid);
  ycbcr_rows_.forEachStep(atlas.ycbcr.data(), [&](YcbcrRows::Step step) {
    sweepRow(
        piece, step.tile_row, [&](uint32_t tile) { return ycbcr_rows_.takes(tile, step); },
        [&](uint32_t tile, uint32_t) { return ycbcr_rows_.rowOf(tile, step); });
  });
  return piece.coverage;
}

Coverage sweepAtlas(const SweepPicture& picture, const TraceOutputs& outputs, WorkerPool& workers,
                    std::vector<ViewSweeper>& sweepers, SweptAtlas& atlas) {
  constexpr uint32_t kRowsPerPiece = 16;
  const uint32_t row_count = picture.plan->rowCount();
  sweepers.resize(std::max(sweepers.size(), size_t{workers.workerCount()}));
  std::vector<Coverage> coverages(workers.workerCount());
  atlas.begin(*picture.job, outputs);
  workers.forEach(
      (row_count + kRowsPerPiece - 1) / kRowsPerPiece, [&](uint32_t piece, uint32_t worker) {
        const uint32_t first = piece * kRowsPerPiece;
        coverages[worker].add(sweepers[worker].sweepRows(
            picture, first, std::min(kRowsPerPiece, row_count - first), outputs, atlas));
      });
  for (size_t worker = 1; worker < coverages.size(); ++worker) {
    coverages[0].add(coverages[worker]);
  }
  return coverages[0];
}

}  // namespace viewloom
