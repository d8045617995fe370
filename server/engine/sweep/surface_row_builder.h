// SPDX-License-Identifier: Apache-2.0
// From columns to the surfaces of a row: facets, links, and the straight runs they make up.
#pragma once

#include <cstdint>

#include "sweep/averaged_color.h"
#include "sweep/link_kernels.h"
#include "sweep/row_source.h"
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
  struct LayerScratch {
    AlignedArray<float> slope_x, slope_y, slope_y_there, left, right;
    AlignedArray<uint8_t> to_right, to_left;
    AlignedArray<uint32_t> texels;
    AlignedArray<int32_t> texel;  // [column]: 256 times its index among those of the row
    AlignedArray<uint32_t> color_here, color_there;
  };
  // A surface that is being followed to the right.
  struct Surface {
    int32_t texel_offset;  // Runs::texel_offset
    float before_inv_z;    // where the run before ends; abi::kNoSurface: none
    uint32_t before_layer;
  };

  bool hasFault(SweepFault fault) const { return planted_fault_ == fault; }
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
  void addSilhouettes(uint32_t layer);
  void addSilhouette(uint32_t layer, Travel travel, uint32_t column, uint8_t link);
  bool isKnownBehind(uint32_t layer, Travel travel, uint32_t column) const;
  float goesOnInFront(uint32_t layer, Travel travel, uint32_t column, float far_inv_z,
                      float reach_px) const;
  int32_t texelBeyondNothing(Travel travel, uint32_t column) const;
  int32_t addBetween(int32_t far_texel, int32_t near_texel);

  uint32_t width_ = 0;
  uint32_t layer_count_ = 0;
  AlignedArray<float> inverse_;  // [n] = 1 / n
  ByLayer<LayerScratch> layers_;
  ByLayer<const float*> inv_z_{};
  ByLayer<const float*> slope_y_{};
  SurfaceSteps steps_;
  SweepFault planted_fault_ = SweepFault::kNone;
  AveragedColor averaged_;
  float reach_x_px_ = 0;
  AlignedArray<uint32_t> chain_;  // texels of a surface, with room before and behind
  float tolerance_ = 0;
  float px_per_inv_z_ = 0;
  bool some_fall_ = false;  // facets below the sky
  SurfaceRow made_;         // with room for the most there can be
};

}  // namespace viewloom
