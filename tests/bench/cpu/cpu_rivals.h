// SPDX-License-Identifier: Apache-2.0
// Rivals that run on the CPU, on all its threads.
//
// embree  a mesh of each layer's samples, traced by Embree 3; left out where it was not installed
// rows    scan conversion of a row's samples, for views that lie in one row with the source
// runs    the same of planar runs, with the nearest sample's colour
#pragma once

#include <memory>
#include <vector>

#include "bench/contestant.h"

namespace viewloom::bench {

std::vector<std::unique_ptr<Contestant>> makeCpuRivals();

}  // namespace viewloom::bench
