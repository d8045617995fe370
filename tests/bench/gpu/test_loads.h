// SPDX-License-Identifier: Apache-2.0
// Small loads from scenes of the oracle.
#pragma once

#include <vector>

#include "bench/bench_load.h"
#include "oracle/scene_generator.h"
#include "oracle/view_generator.h"

namespace viewloom::bench {

// Every sample has a colour of its own; the tolerance is the scene's. `views` have one size and
// stand side by side.
BenchLoad loadOf(const oracle::Scene& scene, const std::vector<oracle::OutputView>& views);

// Beside each other, `step_m` apart, the first `from_x_m` beside the source; with its pinhole.
std::vector<oracle::OutputView> viewsBeside(const oracle::Scene& scene, int count, double from_x_m,
                                            double step_m);

}  // namespace viewloom::bench
