// SPDX-License-Identifier: Apache-2.0
#include "pipeline/picture_cache.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "display/depth_budget.h"
#include "picture/display_sources.h"

namespace viewloom {
namespace {

// A job that no atlas on its way uses. nullptr = all are in use.
std::shared_ptr<TraceJob>* findFree(std::vector<std::shared_ptr<TraceJob>>& jobs) {
  const auto free =
      std::find_if(jobs.begin(), jobs.end(), [](const auto& job) { return job.use_count() == 1; });
  if (free == jobs.end()) return nullptr;
  // The last user finished reading before it let go.
  std::atomic_thread_fence(std::memory_order_acquire);
  return &*free;
}

}  // namespace

absl::StatusOr<PicturePtr> PictureCache::get(const ActiveDisplay& display,
                                             const ResidentStructure& source, const Aim& aim,
                                             const EyePosesPtr& eyes) {
  VIEWLOOM_RETURN_IF_ERROR(validateSourcesOf(display.spec, aim.sources));
  const std::shared_ptr<Entry> kept = entryOf(display.picture_key);
  Entry& entry = *kept;
  std::lock_guard lock(entry.mutex);
  const bool keeps_mirrors = haveMirrors(entry.aim.sources) == haveMirrors(aim.sources);
  const bool is_aimed =
      (aim.standsInOnly() && entry.aim.standsInOnly() && keeps_mirrors) || aim == entry.aim;
  if (std::exchange(entry.taking_count, source.taking.count) != source.taking.count) {
    // The focal plane begins where the new defaults have it.
    entry.focus = {};
    if (entry.focal_distance_m) entry.layout = nullptr;
    entry.focal_distance_m.reset();
  }
  bool is_new = entry.layout == nullptr || entry.defaults != source.defaults || entry.eyes != eyes;
  if (is_new) {
    VIEWLOOM_RETURN_IF_ERROR(layOut(display, source.defaults, eyes, entry));
  }
  if (moveFocus(display.spec, source, entry)) {
    VIEWLOOM_RETURN_IF_ERROR(layOut(display, source.defaults, eyes, entry));
    is_new = true;
  }
  if (!is_new && is_aimed) return entry.jobs.front();
  if (std::shared_ptr<TraceJob>* free = findFree(entry.jobs)) {
    (*free)->layout = entry.layout;
    aimTraceJob(**free, aim.display_pose, aim.sources);
    std::swap(entry.jobs.front(), *free);
  } else {
    entry.jobs.insert(entry.jobs.begin(),
                      std::make_shared<TraceJob>(
                          makeTraceJob(entry.layout, display.spec, aim.display_pose, aim.sources)));
  }
  entry.defaults = source.defaults;
  entry.eyes = eyes;
  entry.aim = aim;
  return entry.jobs.front();
}

std::shared_ptr<PictureCache::Entry> PictureCache::entryOf(const std::string& picture_key) {
  std::lock_guard lock(mutex_);
  std::shared_ptr<Entry>& entry = entries_[picture_key];
  if (!entry) entry = std::make_shared<Entry>();
  return entry;
}

absl::Status PictureCache::layOut(const ActiveDisplay& display, const StreamDefaults& defaults,
                                  const EyePosesPtr& eyes, Entry& entry) const {
  const DisplaySpec& spec = display.spec;
  VIEWLOOM_RETURN_IF_ERROR(validateAtlasLimits(spec, limits_));
  absl::StatusOr<AtlasLayout> made =
      entry.focal_distance_m
          ? makeAtlasLayout(*withFocalDistance(spec, *entry.focal_distance_m), defaults, eyes.get())
          : makeAtlasLayout(spec, defaults, eyes.get());
  if (!made.ok()) return made.status();
  if (display.encoding.color == BandEncoding::kH264) {
    VIEWLOOM_RETURN_IF_ERROR(stackViews(*made));
  }
  entry.layout = std::make_shared<const AtlasLayout>(*std::move(made));
  return absl::OkStatus();
}

// True when the focal plane has moved so far that it shows. What a structure says counts for the
// time since the one before was built, and once: publishers' clocks may stand, and go back.
bool PictureCache::moveFocus(const DisplaySpec& spec, const ResidentStructure& source,
                             Entry& entry) {
  if (spec.focus_following_s == 0) return false;
  const auto budget = depthBudget(*entry.layout, source.stats, source.depths);
  const double suggested_m =
      budget ? budget->suggested_focal_distance_m : entry.layout->focal_distance_m;
  const std::optional<double> moved_m =
      entry.focus.follow(*entry.layout, suggested_m, spec.focus_following_s, source.built_at_ns);
  if (moved_m) entry.focal_distance_m = moved_m;
  return moved_m.has_value();
}

void PictureCache::keepOnly(const std::vector<ActiveDisplayPtr>& displays) {
  std::lock_guard lock(mutex_);
  std::erase_if(entries_, [&](const auto& entry) {
    return std::none_of(displays.begin(), displays.end(), [&](const ActiveDisplayPtr& display) {
      return display->picture_key == entry.first;
    });
  });
}

}  // namespace viewloom
