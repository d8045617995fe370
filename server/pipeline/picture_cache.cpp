// SPDX-License-Identifier: Apache-2.0
#include "pipeline/picture_cache.h"

#include <algorithm>
#include <atomic>
#include <utility>

namespace viewloom {
namespace {

// A job that no atlas on its way uses. nullptr = all are in use.
std::shared_ptr<TraceJob>* findFree(std::vector<std::shared_ptr<TraceJob>>& jobs) {
  const auto free =
      std::find_if(jobs.begin(), jobs.end(), [](const auto& job) { return job.use_count() == 1; });
  if (free == jobs.end()) return nullptr;
  // What its last user read, it read before it let go.
  std::atomic_thread_fence(std::memory_order_acquire);
  return &*free;
}

}  // namespace

absl::StatusOr<PicturePtr> PictureCache::get(const ActiveDisplay& display,
                                             const ResidentStructure& source,
                                             const EyePosesPtr& eyes) {
  VIEWLOOM_RETURN_IF_ERROR(validateSourcesOf(display.spec, source.sources));
  Entry& entry = entries_[display.picture_key];
  // Who stands in the place of the only source sees the same wherever that is.
  const bool stands_in_only =
      !display.spec.world_pose && source.sources.size() == 1 && entry.sources.size() == 1;
  const bool is_aimed = stands_in_only || entry.sources == source.sources;
  if (entry.layout == nullptr || entry.defaults != source.defaults || entry.eyes != eyes) {
    auto layout = makeLayout(display.spec, source.defaults, eyes.get());
    if (!layout.ok()) return layout.status();
    entry.layout = *std::move(layout);
  } else if (is_aimed) {
    return entry.jobs.front();
  }
  const Pose display_pose = displayPose(display.spec, source.sources.front().camera);
  if (std::shared_ptr<TraceJob>* free = findFree(entry.jobs)) {
    (*free)->layout = entry.layout;
    aimTraceJob(**free, display_pose, source.sources);
    std::swap(entry.jobs.front(), *free);
  } else {
    entry.jobs.insert(entry.jobs.begin(),
                      std::make_shared<TraceJob>(
                          makeTraceJob(entry.layout, display.spec, display_pose, source.sources)));
  }
  entry.defaults = source.defaults;
  entry.eyes = eyes;
  entry.sources = source.sources;
  return entry.jobs.front();
}

absl::StatusOr<std::shared_ptr<const AtlasLayout>> PictureCache::makeLayout(
    const DisplaySpec& spec, const StreamDefaults& defaults, const EyePoses* eyes) const {
  VIEWLOOM_RETURN_IF_ERROR(validateAtlasLimits(spec, limits_));
  absl::StatusOr<AtlasLayout> made = makeAtlasLayout(spec, defaults, eyes);
  if (!made.ok()) return made.status();
  return std::make_shared<const AtlasLayout>(*std::move(made));
}

void PictureCache::keepOnly(const std::vector<ActiveDisplayPtr>& displays) {
  std::erase_if(entries_, [&](const auto& entry) {
    return std::none_of(displays.begin(), displays.end(), [&](const ActiveDisplayPtr& display) {
      return display->picture_key == entry.first;
    });
  });
}

}  // namespace viewloom
