// SPDX-License-Identifier: Apache-2.0
#include "picture/display_sources.h"

#include <algorithm>
#include <string>

#include "base/str_cat.h"
#include "display/rgbd.h"

namespace viewloom {

absl::Status validateSourcesOf(const DisplaySpec& spec, std::span<const SeenSource> sources) {
  const bool is_one = sources.size() == 1 && !sources.front().is_cube_map;
  const std::string stream =
      sources.size() == 1 ? "a cube map" : strCat(sources.size(), " sources");
  if (hasLayerBehind(spec) && !is_one) {
    return fieldError(absl::StatusCode::kFailedPrecondition, "rgbd.form",
                      strCat("TWO_LAYERS needs a stream of one source that is not a cube map, and "
                             "this stream has ",
                             stream, "; use COLOR_DEPTH"));
  }
  if (!spec.reflection || !haveMirrors(sources)) return absl::OkStatus();
  if (std::none_of(sources.begin(), sources.end(),
                   [](const SeenSource& source) { return source.is_see_through; })) {
    return absl::OkStatus();
  }
  return fieldError(
      absl::StatusCode::kFailedPrecondition, "effects.reflection",
      "reflections need opaque colour, and this stream has mirrors and transparent colour; leave "
      "reflections out, or publish opaque colour");
}

bool canMerge(const DisplaySpec& spec, size_t source_count) {
  return !hasLayerBehind(spec) && !spec.reflection && source_count <= kMergedSourcesMax;
}

}  // namespace viewloom
