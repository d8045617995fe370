// SPDX-License-Identifier: Apache-2.0
// Where the tile of a view lies.

// Top left corner of a view's tile in the atlas, px. What remains beside the tiles is padding at
// the right and at the top.
export function tileOrigin(layout, view) {
  const row = Math.floor(view / layout.columns);
  const rowFromTop = layout.order === 'BOTTOM_LEFT' ? layout.rows - 1 - row : row;
  return {
    x: (view % layout.columns) * layout.tile_size.width,
    y: layout.padding_top_px + rowFromTop * layout.tile_size.height,
  };
}
