// SPDX-License-Identifier: Apache-2.0
// Blocks of 8x8 px of tiles, as they lie in a band. Blocks begin at the upper left corner of their
// tile; those of a tile row that the band shares with another are shared with its band, too.
#ifndef VIEWLOOM_LIB_MET_BLOCKS_GLSL_
#define VIEWLOOM_LIB_MET_BLOCKS_GLSL_

#include "shared/trace_abi.h"

uvec2 sizeOf(uint size_px) {
  return uvec2(size_px & 0xffffu, size_px >> 16);
}

uvec2 blocksPerTile(GatherPush push) {
  return (sizeOf(push.tile_size_px) + kMetBlockSide_px - 1u) / kMetBlockSide_px;
}

uint blocksPerRow(GatherPush push) {
  return blocksPerTile(push).x * sizeOf(push.tile_grid).x;
}

// Px of the band: [first, end) along both axes.
struct MetBlock {
  uint first_x;
  uint end_x;
  uint first_row;
  uint end_row;
};

// `row`: of blocks, from the first that the band has a part of.
MetBlock metBlock(GatherPush push, uint column, uint row) {
  const uvec2 per_tile = blocksPerTile(push);
  const uvec2 tile_size = sizeOf(push.tile_size_px);
  const uvec2 block = uvec2(column, push.first_block_row + row);
  const uvec2 tile = block / per_tile;
  const uvec2 in_tile = block % per_tile * kMetBlockSide_px;
  const uvec2 first = tile * tile_size + in_tile;
  const uvec2 end = tile * tile_size + min(in_tile + kMetBlockSide_px, tile_size);
  // Rows count from the top of the tiles; the band may begin above that, or further down.
  const int band_first = int(push.first_row) - int(push.padding_top_px);
  const ivec2 rows = clamp(ivec2(first.y, end.y) - band_first, 0, int(push.row_count));
  return MetBlock(first.x, end.x, uint(rows.x), uint(rows.y));
}

#endif  // VIEWLOOM_LIB_MET_BLOCKS_GLSL_
