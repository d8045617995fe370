// SPDX-License-Identifier: Apache-2.0
// One view of a rendered atlas, in the form it is scored in.
#pragma once

#include <vector>

#include "scoring/class_scores.h"
#include "walk/offline_renderer.h"

namespace viewloom {

struct RenderedView {
  ScoredImage image;
  std::vector<PixelClass> classes;  // as the renderer says: covered are hits and known emptiness
};

// Needs linear and mask.
RenderedView cutView(const RenderedAtlas& atlas, uint32_t view, ScoreTransfer transfer);

}  // namespace viewloom
