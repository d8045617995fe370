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
                      strCat("got TWO_LAYERS for a stream of ", stream,
                             ", accepted is one source that is no cube map"));
  }
  if (!spec.reflection || !haveMirrors(sources)) return absl::OkStatus();
  if (std::none_of(sources.begin(), sources.end(),
                   [](const SeenSource& source) { return source.is_see_through; })) {
    return absl::OkStatus();
  }
  return fieldError(
      absl::StatusCode::kFailedPrecondition, "effects.reflection",
      "came for a stream with mirrors of colour that is seen through, accepted is opaque colour");
}

bool canMerge(const DisplaySpec& spec, size_t source_count) {
  return !hasLayerBehind(spec) && !spec.reflection && source_count <= kMergedSourcesMax;
}

}  // namespace viewloom
