// SPDX-License-Identifier: Apache-2.0
// Blocks of 8x8 px of tiles, as they lie in a band. Blocks begin at the upper left corner of their
// tile; those of a tile row that the band shares with another are shared with its band, too.
#ifndef VIEWLOOM_LIB_RAYS_MET_BLOCKS_GLSL_
#define VIEWLOOM_LIB_RAYS_MET_BLOCKS_GLSL_

#include "lib/rays/tile_px.glsl"
#include "shared/lens_abi.h"
#include "shared/trace_abi.h"

// Grid of a band. Block rows are counted from the first that the band has a part of.
struct BlockGrid {
  uvec2 tile_size_px;
  uvec2 tile_count;
  uint padding_top_px;
  uint first_row;  // of the band, in the atlas
  uint row_count;
  uint first_block_row;  // of those of all tile rows
};

BlockGrid gridOf(GatherPush push) {
  return BlockGrid(sizeOf(push.tile_size_px), sizeOf(push.tile_grid), push.padding_top_px,
                   push.first_row, push.row_count, push.first_block_row);
}

BlockGrid gridOf(TracePush push) {
  return BlockGrid(sizeOf(push.tile_size_px), sizeOf(push.tile_grid), push.padding_top_px,
                   push.first_row, push.row_count, push.first_block_row);
}

uvec2 blocksPerTile(BlockGrid grid) {
  return (grid.tile_size_px + kMetBlockSide_px - 1u) / kMetBlockSide_px;
}

uint blocksPerRow(BlockGrid grid) {
  return blocksPerTile(grid).x * grid.tile_count.x;
}

// Px of the band: [first, end) along both axes.
struct MetBlock {
  uint first_x;
  uint end_x;
  uint first_row;
  uint end_row;
};

uvec2 tileOfBlock(BlockGrid grid, uvec2 block) {
  return uvec2(block.x, grid.first_block_row + block.y) / blocksPerTile(grid);
}

// The first px of the block, in its tile.
uvec2 firstInTile(BlockGrid grid, uvec2 block) {
  const uvec2 first_block = tileOfBlock(grid, block) * blocksPerTile(grid);
  return (uvec2(block.x, grid.first_block_row + block.y) - first_block) * kMetBlockSide_px;
}

MetBlock metBlock(BlockGrid grid, uvec2 block) {
  const uvec2 tile = tileOfBlock(grid, block);
  const uvec2 in_tile = firstInTile(grid, block);
  const uvec2 first = tile * grid.tile_size_px + in_tile;
  const uvec2 end =
      tile * grid.tile_size_px + min(in_tile + kMetBlockSide_px, grid.tile_size_px);
  // Rows count from the top of the tiles; the band may begin above that, or further down.
  const int band_first = int(grid.first_row) - int(grid.padding_top_px);
  const ivec2 rows = clamp(ivec2(first.y, end.y) - band_first, 0, int(grid.row_count));
  return MetBlock(first.x, end.x, uint(rows.x), uint(rows.y));
}

#endif  // VIEWLOOM_LIB_RAYS_MET_BLOCKS_GLSL_
