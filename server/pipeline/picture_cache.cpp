// SPDX-License-Identifier: Apache-2.0
#include "pipeline/picture_cache.h"

#include <algorithm>
#include <utility>

namespace viewloom {

absl::StatusOr<PicturePtr> PictureCache::get(const ActiveDisplay& display,
                                             const StreamDefaults& defaults) {
  Entry& entry = entries_[display.picture_key];
  if (entry.picture && entry.defaults == defaults) return entry.picture;
  VIEWLOOM_RETURN_IF_ERROR(validateAtlasLimits(display.spec, limits_));
  absl::StatusOr<AtlasLayout> layout = makeAtlasLayout(display.spec, defaults);
  if (!layout.ok()) return layout.status();
  entry.defaults = defaults;
  entry.picture = std::make_shared<TraceJob>(
      makeTraceJob(std::make_shared<AtlasLayout>(*std::move(layout)), display.spec,
                   displayPose(display.spec, defaults.source_camera), defaults.source_camera,
                   defaults.source_size_px));
  return entry.picture;
}

void PictureCache::keepOnly(const std::vector<ActiveDisplayPtr>& displays) {
  std::erase_if(entries_, [&](const auto& entry) {
    return std::none_of(displays.begin(), displays.end(), [&](const ActiveDisplayPtr& display) {
      return display->picture_key == entry.first;
    });
  });
}

}  // namespace viewloom
