// SPDX-License-Identifier: Apache-2.0
#include "trace/met_blocks.h"

#include <algorithm>

#include "shared/lens_abi.h"

namespace viewloom {
namespace {

constexpr uint32_t blocksIn(uint32_t length_px) {
  return (length_px + abi::kMetBlockSide_px - 1) / abi::kMetBlockSide_px;
}

// Row of blocks for a row of the tiles, which begin below the padding.
uint32_t blockRowOf(const AtlasLayout& layout, uint32_t row) {
  const uint32_t height_px = layout.tile_size_px.height;
  return row / height_px * blocksIn(height_px) + row % height_px / abi::kMetBlockSide_px;
}

}  // namespace

MetBlocks metBlocks(const AtlasLayout& layout, BandRows rows) {
  const uint32_t top_px = layout.padding_top_px;
  const uint32_t per_row = blocksIn(layout.tile_size_px.width) * layout.columns;
  const uint32_t end = rows.first_row + rows.row_count;
  if (end <= top_px) return {.first_row = 0, .row_count = 0, .per_row = per_row};
  const uint32_t first_row = blockRowOf(layout, std::max(rows.first_row, top_px) - top_px);
  return {.first_row = first_row,
          .row_count = blockRowOf(layout, end - 1 - top_px) - first_row + 1,
          .per_row = per_row};
}

// Every tile that a band touches may begin a row of blocks more than its rows fill, and the band
// may begin and end within one.
uint64_t metListsBytes(const AtlasLayout& layout, uint32_t row_count_max) {
  const uint32_t tiles = row_count_max / layout.tile_size_px.height + 2;
  const uint32_t block_rows = blocksIn(row_count_max) + tiles;
  return uint64_t{block_rows} * blocksIn(layout.tile_size_px.width) * layout.columns *
         sizeof(abi::MetList);
}

uint64_t incompleteCount(const TraceJob& job, uint32_t row_count_max) {
  // Px of a run that was not finished are listed once more.
  if (job.gathers_on_host) return 2 * uint64_t{job.layout->size_px.width} * row_count_max;
  return job.mayGather() ? metListsBytes(*job.layout, row_count_max) / sizeof(abi::MetList) : 0;
}

MetRound metRound(uint32_t sample, uint32_t sample_count) {
  constexpr uint32_t kFirstShare = 4;  // of 8, 0.3 dB are lost for a seventh of the time
  MetRound round{.first = 0, .end = std::max(sample_count / kFirstShare, 1U)};
  while (sample >= round.end) round = {round.end, std::min(2 * round.end, sample_count)};
  return round;
}

}  // namespace viewloom
