// SPDX-License-Identifier: Apache-2.0
// Outputs of a swept row beside its colour, for few displays and for tests: depth and mask.
#pragma once

#include "sweep/view_sweeper.h"

namespace viewloom {

struct RowToDescribe {
  const SurfaceRow& row;
  const SweepView& view;
  const SweepFill& fill;
  const SweptRow& swept;
  double y_px = 0;   // in the source
  float view_z = 0;  // Z in the source for a metre along the view's axis
  uint32_t width_px = 0;
  uint32_t stride_px = 1;  // from px to px in the atlas; edges are blended where it is 1
};

// Writes the planes of `outputs` from px `at_px` of the atlas on.
void describeSwept(const RowToDescribe& described, size_t at_px, const TraceOutputs& outputs,
                   SweptAtlas& atlas);

}  // namespace viewloom
