// SPDX-License-Identifier: Apache-2.0
// Which px of which tile stands at a place of an atlas.
#ifndef VIEWLOOM_LIB_RAYS_TILE_PX_GLSL_
#define VIEWLOOM_LIB_RAYS_TILE_PX_GLSL_

// Width in the low half.
uvec2 sizeOf(uint size_px) {
  return uvec2(size_px & 0xffffu, size_px >> 16);
}

struct TilePx {
  uint tile;  // row-major from the top left
  uvec2 px;   // of the tile
  bool exists;
};

// Sizes as of TracePush.
TilePx tilePxAt(uint x, uint row, uint tile_size_px, uint tile_grid, uint padding_top_px) {
  const uvec2 size = sizeOf(tile_size_px);
  const uvec2 grid = sizeOf(tile_grid);
  const uint column = x / size.x;
  const uint tile_row = row < padding_top_px ? grid.y : (row - padding_top_px) / size.y;
  const bool exists = column < grid.x && tile_row < grid.y;
  const uvec2 first_px = uvec2(column * size.x, padding_top_px + tile_row * size.y);
  return TilePx(exists ? tile_row * grid.x + column : 0u, uvec2(x, row) - first_px, exists);
}

#endif  // VIEWLOOM_LIB_RAYS_TILE_PX_GLSL_
