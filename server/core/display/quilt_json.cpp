// SPDX-License-Identifier: Apache-2.0
#include "display/quilt_json.h"

#include "absl/strings/str_format.h"

namespace viewloom {

std::string quiltJson(const QuiltShape& shape) {
  return absl::StrFormat(
      R"({"LKGNumViews":%u,"LKGRows":%u,"LKGColumns":%u,"LKGAspect":%g,"LKGType":"quilt"})",
      shape.view_count, shape.rows, shape.columns, shape.aspect);
}

}  // namespace viewloom
