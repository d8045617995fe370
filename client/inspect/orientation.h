// SPDX-License-Identifier: Apache-2.0
// Depth that lies upside down on its colour picture, by the edges that both show.
#pragma once

#include <vector>

#include "inspect/color_pixels.h"
#include "inspect/suspicions.h"

namespace viewloom::inspect {

// Places where depth has a step, and how well the edges of colour agree with them.
struct EdgeAgreement {
  uint64_t step_count = 0;
  // Shares of the steps where colour changes more than it does beside them. Chance gives a quarter
  // in textures, and less elsewhere.
  double as_is = 0;
  double flipped = 0;  // with the rows of depth upside down
};
EdgeAgreement edgeAgreement(const DepthSamples& samples, const ColorPixels& color);

// upside-down   half of the steps or more agree when flipped, and less than half as many as it is
std::vector<Suspicion> suspectOrientation(const EdgeAgreement& agreement);

}  // namespace viewloom::inspect
