// SPDX-License-Identifier: Apache-2.0
// Loads of pictures with depth that others made.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/load_list.h"

namespace viewloom::bench {

// A FrameManifest (proto viewloom.v1), as a Portrait quilt at the normal span. Its colour is made
// opaque 8-bit sRGB, which is what every contestant takes.
NamedLoad manifestLoad(const std::filesystem::path& manifest);

// A load that there is no data for.
struct SkippedLoad {
  std::string name;
  std::string reason;
};
struct RecordedLoads {
  std::vector<NamedLoad> loads;
  std::vector<SkippedLoad> skipped;
};
// The sets in the folder (support/data_sets.h), as Portrait quilts at the normal span.
RecordedLoads recordedLoads(const std::filesystem::path& data);

}  // namespace viewloom::bench
