// SPDX-License-Identifier: Apache-2.0
#include "schedule/tick_schedule.h"

#include <algorithm>
#include <utility>

#include "picture/display_sources.h"
#include "temporal/output_rate.h"

namespace viewloom {
namespace {

// The structure before the newest is asked, too, where it can be.
bool asksBoth(const DisplaySpec& spec, const StreamInstant& newest) {
  return spec.temporal->mode == TemporalMode::kInterpolate && newest.before &&
         canMerge(spec, newest.structure->sources.size() + newest.before->sources.size());
}

bool isShown(const std::string& picture_key, const std::vector<ActiveDisplayPtr>& displays) {
  return std::ranges::any_of(displays, [&](const ActiveDisplayPtr& display) {
    return display->picture_key == picture_key;
  });
}

}  // namespace

TickSchedule::Noted TickSchedule::note(const std::string& stream,
                                       const std::vector<ActiveDisplayPtr>& displays,
                                       const StreamInstant& newest, const FrameTicketPtr& ticket,
                                       int64_t now_ns) {
  Noted noted;
  noteDisplays(stream, displays, now_ns, noted.released);
  const auto known = streams_.find(stream);
  if (known == streams_.end()) return noted;
  // Two threads may overtake each other.
  if (known->second.structure && known->second.structure->serial > newest.structure->serial) {
    return noted;
  }
  known->second = newest;
  for (auto& [key, picture] : pictures_) {
    if (!ticket || picture.display->stream != stream) continue;
    noted.released.push_back(std::exchange(picture.ticket, ticket));
  }
  noted.is_news = true;
  return noted;
}

void TickSchedule::noteDisplays(const std::string& stream,
                                const std::vector<ActiveDisplayPtr>& displays, int64_t now_ns,
                                std::vector<FrameTicketPtr>& released) {
  std::erase_if(pictures_, [&](const auto& entry) {
    const auto& [picture_key, picture] = entry;
    const bool is_gone = picture.display->stream == stream && !isShown(picture_key, displays);
    if (is_gone) released.push_back(picture.ticket);
    return is_gone;
  });
  bool has_ticks = false;
  for (const ActiveDisplayPtr& display : displays) {
    if (!display->spec.temporal) continue;
    has_ticks = true;
    const OutputClock clock(display->spec.temporal->output_rate_hz, now_ns);
    pictures_.try_emplace(display->picture_key, Picture{display, clock, nullptr});
  }
  if (has_ticks) {
    streams_.try_emplace(stream);
  } else {
    streams_.erase(stream);
  }
}

std::optional<int64_t> TickSchedule::soonestNs() const {
  std::optional<int64_t> soonest_ns;
  for (const auto& [key, picture] : pictures_) {
    soonest_ns = std::min(soonest_ns.value_or(INT64_MAX), picture.clock.dueNs());
  }
  return soonest_ns;
}

std::vector<TickSchedule::DueTick> TickSchedule::takeDue(int64_t now_ns) {
  std::vector<DueTick> all;
  for (auto& [key, picture] : pictures_) {
    const auto tick = picture.clock.take(now_ns);
    if (!tick) continue;
    const StreamInstant& newest = streams_.at(picture.display->stream);
    const DisplaySpec& spec = picture.display->spec;
    const OutputTick output{.due_ns = tick->due_ns,
                            .shown = shownTo(spec, newest.motion, tick->due_ns),
                            .frames_apart_ns = newest.motion.interval_ns};
    all.push_back({.display = picture.display,
                   .job = {.picture_key = key,
                           .structure = newest.structure,
                           .ticket = std::exchange(picture.ticket, nullptr),
                           .tick = output,
                           .before = asksBoth(spec, newest) ? newest.before : nullptr,
                           .payers = picture.display->viewers},
                   .missed_count = tick->missed_count});
  }
  return all;
}

void TickSchedule::giveBack(AtlasJob& job) {
  if (!job.ticket) return;
  const auto picture = pictures_.find(job.picture_key);
  if (picture == pictures_.end()) return;
  if (streams_.at(picture->second.display->stream).structure->serial != job.structure->serial) {
    return;
  }
  picture->second.ticket.swap(job.ticket);
}

}  // namespace viewloom
