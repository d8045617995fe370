// SPDX-License-Identifier: Apache-2.0
#include "pipeline/begun_runs.h"

#include <algorithm>

namespace viewloom {

void BegunRuns::remove(const AtlasRun& run) {
  std::erase_if(runs_, [&](const AtlasRunPtr& begun) { return begun.get() == &run; });
}

void BegunRuns::clear() {
  for (const AtlasRunPtr& run : runs_) run->making = nullptr;
  runs_.clear();
}

bool BegunRuns::hasTracked() const {
  return std::any_of(runs_.begin(), runs_.end(),
                     [](const AtlasRunPtr& run) { return run->isTracked(); });
}

AtlasRunPtr BegunRuns::soonest() const {
  const auto soonest = std::min_element(
      runs_.begin(), runs_.end(),
      [](const AtlasRunPtr& a, const AtlasRunPtr& b) { return goesFirstOnDevice(*a, *b); });
  return soonest == runs_.end() ? nullptr : *soonest;
}

AtlasRunPtr BegunRuns::inTurn(const AtlasRun& first) const {
  const bool is_over = first.isTracked() ? eyes_turn_.isOver() : short_turn_.isOver();
  if (!is_over || first.isLong()) return nullptr;
  AtlasRunPtr soonest;
  for (const AtlasRunPtr& run : runs_) {
    const bool waits = first.isTracked() ? !run->isTracked() : run->isLong();
    if (waits && (!soonest || goesFirstOnDevice(*run, *soonest))) soonest = run;
  }
  return soonest;
}

AtlasRunPtr BegunRuns::inSlot() const {
  const auto run = std::find_if(runs_.begin(), runs_.end(), [](const AtlasRunPtr& begun) {
    return begun->making && begun->making->holdsRoom();
  });
  return run == runs_.end() ? nullptr : *run;
}

void BegunRuns::note(AtlasRun& run, uint64_t ray_count) {
  const auto work = int64_t(ray_count);
  eyes_turn_.note(run.isTracked(), work);
  if (!run.isTracked()) short_turn_.note(!run.isLong(), work);
  run.submitted_rays += ray_count;
}

}  // namespace viewloom
