// SPDX-License-Identifier: Apache-2.0
#include "display/quilt_json.h"

#include "absl/strings/str_format.h"

namespace viewloom {

std::string quiltJson(const QuiltTags& tags) {
  return absl::StrFormat(
      R"({"LKGNumViews":%u,"LKGRows":%u,"LKGColumns":%u,"LKGAspect":%g,"LKGType":"quilt"})",
      tags.view_count, tags.rows, tags.columns, tags.aspect);
}

}  // namespace viewloom
