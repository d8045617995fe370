// SPDX-License-Identifier: Apache-2.0
// From columns to the surfaces of a row: facets, links, and the straight runs they make up.
#pragma once

#include <cstdint>

#include "sweep/averaged_color.h"
#include "sweep/row_facets.h"
#include "sweep/surface_row.h"

namespace viewloom {

// Keeps what rows need on their way. Thread-safety: none; one a thread.
class SurfaceRowBuilder {
 public:
  // For rows of this source, as it is now; colour is averaged so far.
  void begin(const RowSource& source, const ColorReach& reach);
  // The surfaces at height `y_px` of the source, straight within `tolerance`, 1/m; until the next.
  // Views move by at most `px_per_inv_z` along the row.
  SurfaceRow& build(const RowSource& source, double y_px, float tolerance, float px_per_inv_z);

 private:
  // A surface that is being followed to the right.
  struct Surface {
    int32_t texel_offset;  // Runs::texel_offset
    float before_inv_z;    // where the run before ends; abi::kNoSurface: none
    uint32_t before_layer;
  };

  void reserve(const DepthColumns& columns);
  void findFacets(const RowSource& source, int y, float dy);
  void blendTexels(const RowSource& source, int y, float dy);
  void followSurface(uint32_t layer, uint32_t column);
  void averageAlong(uint32_t first, uint32_t end, bool begins_deep, bool ends_deep);
  void noteMixed(uint32_t base, bool begins_deep, bool ends_deep);
  void followPiece(Surface& surface, uint32_t layer, uint32_t first, uint32_t last);
  void followFallingFacet(Surface& surface, uint32_t layer, uint32_t column);
  uint32_t findFalling(uint32_t layer, uint32_t first, uint32_t last) const;
  void addRun(Surface& surface, uint32_t layer, float begin_px, float end_px, float begin_inv_z,
              float end_inv_z);

  RowFacets row_;
  AlignedArray<float> inverse_;  // [n] = 1 / n
  ByLayer<const float*> slope_y_{};
  AveragedColor averaged_;
  float reach_x_px_ = 0;
  AlignedArray<uint32_t> chain_;  // texels of a surface, with room before and behind
  float tolerance_ = 0;
  bool some_fall_ = false;  // facets below the sky
  SurfaceRow made_;         // with room for the most there can be
};

}  // namespace viewloom
