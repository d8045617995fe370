// SPDX-License-Identifier: Apache-2.0
// The named loads of the benchmark.
#pragma once

#include <filesystem>
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

// About a dozen that show each property once, at 1920x1080 and a Portrait quilt unless named.
std::vector<NamedLoad> quickLoads();
// Those, and every scene, number of layers, span and display with each other.
std::vector<NamedLoad> fullLoads();
// For the build alone: scenes, layers, noise and sizes; their views do not matter.
std::vector<NamedLoad> buildLoads();
// A FrameManifest (proto viewloom.v1), as a Portrait quilt at the normal span.
NamedLoad manifestLoad(const std::filesystem::path& manifest);

}  // namespace viewloom::bench
