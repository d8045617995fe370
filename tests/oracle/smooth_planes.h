// SPDX-License-Identifier: Apache-2.0
// Coarse depth as shaders/structure.md smooths it, by definition alone.
#pragma once

#include "oracle/oracle_source.h"

namespace viewloom::oracle {

// Measurements of a source, 1/m.
struct Coarseness {
  float reach = 0;  // 0 = fine
  float step = 0;
  float sigma = 0;
};

InvZPlanes smoothedPlanes(const InvZPlanes& canonical_planes, const Coarseness& coarseness);

}  // namespace viewloom::oracle
