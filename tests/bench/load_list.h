// SPDX-License-Identifier: Apache-2.0
// The named loads of the benchmark.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/load_maker.h"

namespace viewloom::bench {

// A load before it is made: all of them at once would not fit in memory.
struct NamedLoad {
  std::string name;
  std::function<BenchLoad(const LoadMaker&)> make;
};

// Loads that show each property once, at 1920x1080 and a Portrait quilt unless named; 67 million
// rays of a 32" quilt are the largest.
std::vector<NamedLoad> quickLoads();
// Those; every scene, number of layers, span and display with each other; and 3840x2160 in four
// layers, of which all contestants together take 11 GB of memory and minutes a round.
std::vector<NamedLoad> fullLoads();
// For the build alone: scenes, layers, noise and sizes; their views do not matter.
std::vector<NamedLoad> buildLoads();

}  // namespace viewloom::bench
