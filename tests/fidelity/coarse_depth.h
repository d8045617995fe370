// SPDX-License-Identifier: Apache-2.0
// The depth of a set as coarser sensors and formats would have it.
#pragma once

#include <vector>

#include "frame/frame.h"
#include "support/data_sets.h"

namespace viewloom::fidelity {

struct CoarseDepth {
  std::vector<float> disparity_px;  // as DataSet has it: what the rivals are given
  // The same as samples of a plane: what viewloom is given.
  PlaneEncoding encoding = PlaneEncoding::kDepthF32;
  DepthFormat format;
  SharedBytes samples;
};

// So many codes, evenly spaced in inverse depth over the range of the set.
CoarseDepth quantizedDepth(const test::DataSet& set, uint32_t code_count);
// Independent noise of every sample but those of the sky, px of disparity between source and
// baseline.
CoarseDepth noisyDepth(const test::DataSet& set, double sigma_px);

}  // namespace viewloom::fidelity
