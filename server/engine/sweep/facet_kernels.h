// SPDX-License-Identifier: Apache-2.0
// Rows of columns to rows of facets and to straight runs of them, with the vectors of the CPU it
// runs on. What they mean: shaders/structure.md. Every array may be read and written a vector
// beyond its width.
#pragma once

#include <array>
#include <cstdint>

#include "shared/structure_abi.h"
#include "sweep/surface_row.h"

namespace viewloom {

// inv_z of five rows of a source, from two above to two below; each with its guard.
struct FiveRows {
  std::array<ByLayer<const float*>, 5> inv_z;
  uint32_t layer_count = 0;
  uint32_t width = 0;
};

// Slopes of the facets of the middle row, 1/m per px, as they are stored.
void findSlopesX(const FiveRows& rows, const ByLayer<float*>& slope);
void findSlopesY(const FiveRows& rows, const ByLayer<float*>& slope);

// Facets of a row along one axis; `slope` is that along the axis.
struct FacetRow {
  ByLayer<const float*> inv_z;
  ByLayer<const float*> slope;
  uint32_t layer_count = 0;
  uint32_t width = 0;
};

// Where the facets of a row meet its left and right edges at the height `dy` px below its samples,
// never below 0; abi::kNoSurface where there is none.
// Returns whether some facet falls below 0 between its edges.
struct EdgeRow {
  ByLayer<float*> left;
  ByLayer<float*> right;
};
bool findEdges(const FacetRow& row, const ByLayer<const float*>& slope_y, float dy,
               const EdgeRow& edges);

// Facets of a layer, all linked to the next, that straight runs are made of.
struct RunSearch {
  const float* left = nullptr;     // [column], 1/m
  const float* right = nullptr;    // [column]
  const float* inverse = nullptr;  // [n] = 1 / n
  uint32_t last = 0;               // column
  float tolerance = 0;             // 1/m
};
// The column behind the longest run from the left edge of `begin` that a line stays within the
// tolerance of, and the line's inv_z there: in the middle of those that do.
uint32_t findRunEnd(const RunSearch& search, uint32_t begin, float* end_inv_z);

}  // namespace viewloom
