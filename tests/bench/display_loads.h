// SPDX-License-Identifier: Apache-2.0
// Every preset as a display: its quilt, its panel's own px, and panels of other numbers of views.
#pragma once

#include <string>
#include <vector>

#include "display/display_spec.h"

namespace viewloom::bench {

struct DisplayLoad {
  std::string name;  // "portrait quilt", "portrait native"
  DisplaySpec spec;  // completed
};

// `shrink`: sides are so many times smaller. `cone_rad`: of every display; 0 = the preset's.
std::vector<DisplayLoad> displayLoads(uint32_t shrink, double cone_rad);

}  // namespace viewloom::bench
