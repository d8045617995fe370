// SPDX-License-Identifier: Apache-2.0
// Some rows of one layer's depth grid as quads in (x px, y px, 1/Z).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bench/bench_load.h"

namespace viewloom::bench {

struct MeshVertex {
  float x_px = 0;
  float y_px = 0;
  float inv_z = 0;
};
using MeshQuad = std::array<uint32_t, 4>;  // vertices, around it

// A cell lies between four samples. If its four edges connect them, it is one quad between their
// centres. In any other cell, and beyond the image's border, each sample keeps its quarter of a px,
// flat: so a surface ends where its samples' footprints do, and a lone sample is a px.
struct MeshStrip {
  uint32_t layer = 0;
  // Rows of cells; row c lies between the samples' rows c - 1 and c.
  uint32_t row_begin = 0;
  uint32_t row_end = 0;

  std::vector<MeshQuad> quads;  // of the layer's vertices, which are its samples
  std::vector<MeshVertex> rim_vertices;
  std::vector<MeshQuad> rim_quads;
  std::vector<uint32_t> rim_rgba;  // [rim quad]

  // Reuses its memory.
  void make(const LoadSource& source);

 private:
  void addQuarters(const LoadSource& source, int x, int y);
};

}  // namespace viewloom::bench
