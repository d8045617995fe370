// SPDX-License-Identifier: Apache-2.0
// Steps of 1/Z between two surfaces side by side: which are within one surface, and which lead to
// another thing (shaders/structure.md, Steps).
#pragma once

#include <algorithm>

namespace viewloom {

// A share of how far the nearer surface lies before `from`, and no less than `least`.
struct StepRule {
  float least = 0;  // 1/m
  float share = 0;  // below 1
  float from = 0;   // 1/m

  float at(float nearer_inv_z) const { return std::max(least, share * (nearer_inv_z - from)); }
  // The nearer surface of a step that leads to `inv_z`.
  float before(float inv_z) const {
    return std::max(inv_z + least, from + (inv_z - from) / (1 - share));
  }
};

struct SurfaceSteps {
  StepRule kappa;         // neighbours that step by no more are one surface
  StepRule deep;          // neighbours that step by more are two things
  float inv_z_range = 0;  // 1/Z that the source shows, from far to near, 1/m
};

}  // namespace viewloom
