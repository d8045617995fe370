// SPDX-License-Identifier: Apache-2.0
// Metadata of a quilt, for players that read it instead of the file's name.
#pragma once

#include <cstdint>
#include <string>

namespace viewloom {

struct QuiltTags {
  uint32_t view_count = 0;
  uint32_t columns = 0;
  uint32_t rows = 0;
  double aspect = 0;  // of a view as shown
};

// {"LKGNumViews":48,"LKGRows":6,"LKGColumns":8,"LKGAspect":0.75,"LKGType":"quilt"}
std::string quiltJson(const QuiltTags& tags);

}  // namespace viewloom
