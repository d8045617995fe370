// SPDX-License-Identifier: Apache-2.0
#include "sweep/row_source.h"

#include <algorithm>

namespace viewloom {

FiveRows rowsAround(const DepthColumns& columns, int y) {
  FiveRows rows{.inv_z = {}, .layer_count = columns.layerCount(), .width = columns.sizePx().width};
  for (int k = 0; k < 5; ++k) {
    for (uint32_t i = 0; i < rows.layer_count; ++i) {
      rows.inv_z[size_t(k)][i] = columns.row(i, y + k - 2);
    }
  }
  return rows;
}

const uint32_t* readableColorRow(const RowSource& source, uint32_t layer, int y, uint32_t* copy) {
  const SizePx size_px = source.columns->sizePx();
  const uint32_t* const row = source.color[layer] + size_t(y) * size_px.width;
  if (uint32_t(y) + 1 < size_px.height && size_px.width >= kRowSlack) return row;
  std::copy_n(row, size_px.width, copy);
  return copy;
}

}  // namespace viewloom
