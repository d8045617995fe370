// SPDX-License-Identifier: Apache-2.0
// Depth warps anyone could write, as measures of what a view is worth, and the mask by which all
// are scored. All move pixels along lines of the image (support/line_map.h).
#pragma once

#include <string>
#include <vector>

#include "scoring/image_score.h"
#include "support/data_sets.h"

namespace viewloom::fidelity {

// A method by where it cuts: neighbours whose disparities differ by more px are not connected.
struct Rival {
  std::string name;
  double cut_px = 0;
};
// The splat connects nothing, so each pixel goes where its middle falls; the sheet connects all.
std::vector<Rival> rivalsOf(double mesh_cut_px);

// The view by a rival: colours of the source, which is in the transfer that is scored, in
// proportion between connected pixels. Holes are filled from the farther side of their line.
ScoredImage rivalView(const ScoredImage& source, const test::DataSet& set,
                      const test::TrueView& view, const Rival& rival);

// Knowledge of the source about a view, whatever method makes it. Covered: reached by the forward
// map of the source, with neighbours connected up to `cut_px`. Outside: nothing covered lies
// between the pixel and an end of its line. The others are hidden.
std::vector<PixelClass> classesOf(const test::DataSet& set, const test::TrueView& view,
                                  double cut_px);

}  // namespace viewloom::fidelity
