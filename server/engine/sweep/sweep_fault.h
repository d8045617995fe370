// SPDX-License-Identifier: Apache-2.0
// Mistakes that tests plant in the sweep, to prove that they would be found. The product has none.
#pragma once

#include <cstdint>

namespace viewloom {

enum class SweepFault : uint8_t {
  kNone,
  // In the surfaces of a row.
  kRowOff,         // facets are taken at the height of their samples
  kRunsOff,        // runs lie a px aside
  kCrossLinks,     // surfaces end where they go on in another layer
  kBridges,        // connected surfaces have cracks where they step
  kTolerance,      // runs stray eight times as far as they may
  kFallsBelowSky,  // facets that fall below the sky go straight to its edge
  kGoesOnBehind,   // who is behind a surface comes out where it goes on in a deeper layer
  kEntryInFront,   // who enters from the side is in front
  // In what rays meet.
  kLayerDropped,    // only layer 0 is painted
  kPassedIgnored,   // deeper layers are hit before the one before them was passed
  kLastWins,        // what is painted last hides what is nearer
  kFarSideEnds,     // far sides end at their silhouettes
  kFarSideEndless,  // far sides go on however far
};

}  // namespace viewloom
