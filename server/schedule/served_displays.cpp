// SPDX-License-Identifier: Apache-2.0
#include "schedule/served_displays.h"

#include <algorithm>
#include <utility>

namespace viewloom {
namespace {

// Since a display was shown the same structure.
bool hasMoved(const AtlasJob& job, const std::optional<ShownInstant>& shown) {
  return job.tick && shown && !job.tick->shown.looksLike(*shown);
}

}  // namespace

void ServedDisplays::forgetOthers(const std::vector<ActiveDisplayPtr>& displays) {
  std::erase_if(served_, [&](const auto& entry) {
    return std::ranges::find(displays, entry.first, &ActiveDisplay::id) == displays.end();
  });
}

UnservedDisplays ServedDisplays::find(const AtlasJob& job) {
  std::lock_guard lock(mutex_);
  // Under the lock: what an older list lacks may have been served since.
  const std::vector<ActiveDisplayPtr> all = broadcaster_.displays("");
  const uint64_t serial = job.structure->serial;
  if (served_.size() > all.size()) forgetOthers(all);
  UnservedDisplays unserved;
  for (const ActiveDisplayPtr& display : all) {
    if (display->picture_key != job.picture_key) continue;
    // A tracked display is the only one of its picture.
    if (display->eyes) unserved.eyes = display->eyes->newest();
    const bool have_eyes_moved = display->eyes && unserved.eyes != display->eyes->used();
    const Served& served = served_[display->id];
    const bool is_newer = serial > served.serial && !job.is_for_eyes;
    const bool has_moved =
        serial == served.serial &&
        (have_eyes_moved || hasMoved(job, served.shown) || display->isWantedAgain());
    if (!is_newer && !has_moved) continue;
    unserved.displays.push_back(display);
  }
  return unserved;
}

void ServedDisplays::note(const AtlasJob& job, const UnservedDisplays& served) {
  std::lock_guard lock(mutex_);
  for (const ActiveDisplayPtr& display : served.displays) {
    Served& last = served_[display->id];
    last = {job.structure->serial, {}};
    if (display->eyes) display->eyes->noteUsed(served.eyes);
    if (job.tick) last.shown = job.tick->shown;
  }
}

}  // namespace viewloom
