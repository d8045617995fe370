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
                                             const ResidentStructure& source) {
  VIEWLOOM_RETURN_IF_ERROR(validateSourcesOf(display.spec, source.sources));
  Entry& entry = entries_[display.picture_key];
  if (entry.defaults != source.defaults) entry.jobs.clear();
  // Who stands in the place of the only source sees the same wherever that is.
  const bool stands_in_only =
      !display.spec.world_pose && source.sources.size() == 1 && entry.sources.size() == 1;
  const bool is_aimed = stands_in_only || entry.sources == source.sources;
  if (!entry.jobs.empty() && is_aimed) return entry.jobs.front();
  if (std::shared_ptr<TraceJob>* free = findFree(entry.jobs)) {
    aimTraceJob(**free, displayPose(display.spec, source.sources.front().camera), source.sources);
    std::swap(entry.jobs.front(), *free);
  } else {
    auto job = makeJob(display, source, entry);
    if (!job.ok()) return job.status();
    entry.jobs.insert(entry.jobs.begin(), *std::move(job));
  }
  entry.defaults = source.defaults;
  entry.sources = source.sources;
  return entry.jobs.front();
}

absl::StatusOr<std::shared_ptr<TraceJob>> PictureCache::makeJob(const ActiveDisplay& display,
                                                                const ResidentStructure& source,
                                                                const Entry& entry) const {
  std::shared_ptr<const AtlasLayout> layout;
  if (!entry.jobs.empty()) {
    layout = entry.jobs.front()->layout;
  } else {
    VIEWLOOM_RETURN_IF_ERROR(validateAtlasLimits(display.spec, limits_));
    absl::StatusOr<AtlasLayout> made = makeAtlasLayout(display.spec, source.defaults);
    if (!made.ok()) return made.status();
    layout = std::make_shared<AtlasLayout>(*std::move(made));
  }
  return std::make_shared<TraceJob>(
      makeTraceJob(std::move(layout), display.spec,
                   displayPose(display.spec, source.sources.front().camera), source.sources));
}

void PictureCache::keepOnly(const std::vector<ActiveDisplayPtr>& displays) {
  std::erase_if(entries_, [&](const auto& entry) {
    return std::none_of(displays.begin(), displays.end(), [&](const ActiveDisplayPtr& display) {
      return display->picture_key == entry.first;
    });
  });
}

}  // namespace viewloom
