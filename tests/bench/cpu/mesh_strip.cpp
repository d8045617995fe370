// SPDX-License-Identifier: Apache-2.0
#include "bench/cpu/mesh_strip.h"

#include <algorithm>
#include <cmath>

namespace viewloom::bench {

void MeshStrip::make(const LoadSource& source) {
  quads.clear();
  rim_vertices.clear();
  rim_quads.clear();
  rim_rgba.clear();
  const int width_px = int(source.size_px.width);
  const int height_px = int(source.size_px.height);
  const auto are_connected = [kappa = source.kappa](float a, float b) {
    return std::abs(a - b) <= kappa.at(std::max(a, b));
  };
  const float* const inv_z = source.inv_z[layer].data();
  for (int y = int(row_begin) - 1; y < int(row_end) - 1; ++y) {
    const bool has_rows = y >= 0 && y + 1 < height_px;
    const float* const above = inv_z + ptrdiff_t{std::max(y, 0)} * width_px;
    const float* const below = has_rows ? above + width_px : above;
    for (int x = -1; x < width_px; ++x) {
      if (has_rows && x >= 0 && x + 1 < width_px) {
        const float a = above[x], b = above[x + 1], c = below[x], d = below[x + 1];
        if (std::min(std::min(a, b), std::min(c, d)) >= 0 && are_connected(a, b) &&
            are_connected(c, d) && are_connected(a, c) && are_connected(b, d)) {
          const uint32_t at = uint32_t(y * width_px + x);
          const uint32_t under = at + uint32_t(width_px);
          quads.push_back({at, at + 1, under + 1, under});
          continue;
        }
      }
      addQuarters(source, x, y);
    }
  }
}

void MeshStrip::addQuarters(const LoadSource& source, int x, int y) {
  const int width_px = int(source.size_px.width);
  const int height_px = int(source.size_px.height);
  const float right = float(x + 1);  // the corner that the cell's samples share
  const float bottom = float(y + 1);
  for (const int row : {y, y + 1}) {
    for (const int column : {x, x + 1}) {
      if (column < 0 || row < 0 || column >= width_px || row >= height_px) continue;
      const size_t sample = size_t(row) * size_t(width_px) + size_t(column);
      const float w = source.inv_z[layer][sample];
      if (w < 0) continue;
      const float center_x = float(column) + 0.5F;
      const float center_y = float(row) + 0.5F;
      const uint32_t at = uint32_t(rim_vertices.size());
      rim_vertices.push_back({center_x, center_y, w});
      rim_vertices.push_back({right, center_y, w});
      rim_vertices.push_back({right, bottom, w});
      rim_vertices.push_back({center_x, bottom, w});
      rim_quads.push_back({at, at + 1, at + 2, at + 3});
      rim_rgba.push_back(source.rgba[layer][sample]);
    }
  }
}

}  // namespace viewloom::bench
