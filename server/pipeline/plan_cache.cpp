// SPDX-License-Identifier: Apache-2.0
#include "pipeline/plan_cache.h"

#include <algorithm>
#include <utility>

namespace viewloom {

// Planned without the lock: of another picture it may take long.
std::optional<PlannedPicture> PlanCache::get(const AtlasJob& job, const PicturePtr& picture) {
  Entry last;
  {
    std::lock_guard lock(mutex_);
    last = entries_[job.picture_key];
  }
  std::optional<PlannedPicture> planned = planAnew(job, picture, last);
  std::lock_guard lock(mutex_);
  std::swap(last, entries_[job.picture_key]);
  entries_[job.picture_key] = planned ? Entry{picture, *planned} : Entry{};
  return planned;
}

// Engines that come before the one of the last plan are asked again: what they could not make of
// another frame they may make of this one.
std::optional<PlannedPicture> PlanCache::planAnew(const AtlasJob& job, const PicturePtr& picture,
                                                  const Entry& last) const {
  for (size_t engine = 0; engine < engines_.all.size(); ++engine) {
    const PreparedFrame* const frame = job.structure->forms->of(engine);
    if (frame == nullptr) continue;
    const bool is_planned = last.picture == picture && last.planned.engine == engine;
    if (is_planned && last.planned.plan->holdsFor(*frame)) return last.planned;
    if (PlanPtr plan = engines_.all[engine]->plan(picture, *frame)) {
      return PlannedPicture{engine, std::move(plan)};
    }
  }
  return std::nullopt;
}

void PlanCache::keepOnly(const std::vector<ActiveDisplayPtr>& displays) {
  std::vector<Entry> dropped;  // let go after the lock
  std::lock_guard lock(mutex_);
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    const bool is_shown = std::ranges::any_of(displays, [&](const ActiveDisplayPtr& display) {
      return display->picture_key == entry->first;
    });
    if (!is_shown) dropped.push_back(std::move(entry->second));
    entry = is_shown ? std::next(entry) : entries_.erase(entry);
  }
}

}  // namespace viewloom
