// SPDX-License-Identifier: Apache-2.0
// The silhouettes of a row of surfaces: the edges where nothing is linked.
#pragma once

#include <cstdint>

#include "sweep/row_facets.h"
#include "sweep/surface_row.h"

namespace viewloom {

// Adds them to a row whose surfaces are followed. Facets and row outlive it. Thread-safety: none.
class SurfaceRowSilhouettes {
 public:
  // Runs are straight within `tolerance`, 1/m. Views move by at most `px_per_inv_z` along the row.
  SurfaceRowSilhouettes(const RowFacets& row, float tolerance, float px_per_inv_z, SurfaceRow& made)
      : row_(row), tolerance_(tolerance), px_per_inv_z_(px_per_inv_z), made_(made) {}

  // Where rays pass behind the layer: surfaces begin, for those that come from the left, or end; or
  // it goes on from a nearer layer, which the ray has been behind before.
  void add(uint32_t layer);

 private:
  void addSilhouette(uint32_t layer, Travel travel, uint32_t column, uint8_t link);
  bool isKnownBehind(uint32_t layer, Travel travel, uint32_t column) const;
  float goesOnInFront(uint32_t layer, Travel travel, uint32_t column, float far_inv_z,
                      float reach_px) const;
  int32_t texelBeyondNothing(Travel travel, uint32_t column) const;
  int32_t addBetween(int32_t far_texel, int32_t near_texel);

  const RowFacets& row_;
  const float tolerance_;
  const float px_per_inv_z_;
  SurfaceRow& made_;
};

}  // namespace viewloom
