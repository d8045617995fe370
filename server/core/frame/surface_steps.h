// SPDX-License-Identifier: Apache-2.0
// Steps of 1/Z between neighbouring samples: those within one surface, and those to another object
// (shaders/structure.md, Steps).
#pragma once

#include <algorithm>

namespace viewloom {

// Limit of a step: a share of the distance in 1/Z from `from` to the nearer surface, at least
// `least`.
struct StepRule {
  float least = 0;  // 1/m
  float share = 0;  // below 1
  float from = 0;   // 1/m

  float at(float nearer_inv_z) const { return std::max(least, share * (nearer_inv_z - from)); }
  // 1/Z of the nearer surface in the largest step from a farther surface at `inv_z`.
  float before(float inv_z) const {
    return std::max(inv_z + least, from + (inv_z - from) / (1 - share));
  }
};

struct SurfaceSteps {
  StepRule kappa;         // neighbours with smaller steps are one surface
  StepRule deep;          // neighbours with larger steps are two objects
  float inv_z_range = 0;  // range of 1/Z in the source, 1/m
};

}  // namespace viewloom
