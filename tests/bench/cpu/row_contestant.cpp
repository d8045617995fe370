// SPDX-License-Identifier: Apache-2.0
#include "bench/cpu/row_contestant.h"

#include <algorithm>
#include <cmath>

#include "bench/cpu/light.h"
#include "bench/cpu/parallel_chunks.h"

namespace viewloom::bench {
namespace {

constexpr uint32_t kRowsPerChunk = 4;

RowView makeRowView(const abi::ViewParams& tile) {
  // Eyes are in the source's plane and axes are the source's: one depth for the whole tile.
  const double z = double{tile.direction.z};
  const double step_px = double{tile.direction_dx.x} / z;
  return {.start_px = float(double{tile.direction.x} / z + 0.5 * step_px),
          .step_px = float(step_px),
          .eye_px_m = tile.eye.x};
}

}  // namespace

bool RowContestant::takes(const BenchLoad& load) const {
  return load.is_one_axis &&
         std::all_of(load.job.tiles.begin(), load.job.tiles.end(), [](const auto& tile) {
           return tile.direction.z > 0 && tile.direction_dx.x > 0;
         });
}

void RowContestant::prepare(const BenchLoad& load) {
  load_ = &load;
  background_ = packBackground(load.job.background_rgb);
  views_.clear();
  const AtlasLayout& layout = *load.job.layout;
  std::vector<UsedRow> rows(load.source.size_px.height);
  for (uint32_t view = 0; view < load.job.tiles.size(); ++view) {
    const abi::ViewParams& tile = load.job.tiles[view];
    views_.push_back(makeRowView(tile));
    const size_t top_px =
        layout.padding_top_px + view / layout.columns * layout.tile_size_px.height;
    const size_t left_px = view % layout.columns * layout.tile_size_px.width;
    for (uint32_t y = 0; y < layout.tile_size_px.height; ++y) {
      const double source_y = (double{tile.direction.y} + (y + 0.5) * double{tile.direction_dy.y}) /
                              double{tile.direction.z};
      if (!(source_y >= 0 && source_y < load.source.size_px.height)) continue;
      std::vector<Target>& targets = rows[uint32_t(source_y)].targets;
      targets.push_back({.view = view,
                         .offset_px = (top_px + y) * layout.size_px.width + left_px,
                         .is_repeated = !targets.empty() && targets.back().view == view});
    }
  }
  rows_.clear();
  for (uint32_t row = 0; row < rows.size(); ++row) {
    if (rows[row].targets.empty()) continue;
    rows[row].source_row = row;
    rows_.push_back(std::move(rows[row]));
  }
  rgba_.assign(layout.size_px.area(), background_);
}

void RowContestant::traceRows(float* inv_z) {
  const uint32_t width_px = load_->job.layout->tile_size_px.width;
  forChunks(uint32_t(rows_.size()), kRowsPerChunk,
            [&](uint32_t thread, uint32_t first, uint32_t last) {
              for (uint32_t row = first; row < last; ++row) {
                enterRow(thread, rows_[row].source_row);
                RowOutput output{.width_px = width_px};
                for (const Target& target : rows_[row].targets) {
                  const RowOutput before = output;
                  output.rgba = rgba_.data() + target.offset_px;
                  output.inv_z = inv_z == nullptr ? nullptr : inv_z + target.offset_px;
                  if (!target.is_repeated) {
                    drawRow(thread, views_[target.view], output);
                    continue;
                  }
                  std::copy_n(before.rgba, width_px, output.rgba);
                  if (inv_z != nullptr) std::copy_n(before.inv_z, width_px, output.inv_z);
                }
              }
            });
}

Picture RowContestant::picture() {
  Picture picture;
  picture.inv_z.assign(rgba_.size(), kNoSurface);
  traceRows(picture.inv_z.data());
  picture.rgba = rgba_;
  return picture;
}

}  // namespace viewloom::bench
