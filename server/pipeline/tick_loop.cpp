// SPDX-License-Identifier: Apache-2.0
#include "pipeline/tick_loop.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/thread_name.h"
#include "picture/display_sources.h"
#include "temporal/output_rate.h"

namespace viewloom {
namespace {

// The structure before the newest is asked, too, where it can be.
bool asksBoth(const DisplaySpec& spec, const StreamInstant& newest) {
  return spec.temporal->mode == TemporalMode::kInterpolate && newest.before &&
         canMerge(spec, newest.structure->sources.size() + newest.before->sources.size());
}

}  // namespace

TickLoop::TickLoop(const PipelineLinks& links, OfferTick offer_tick)
    : links_(links), offer_tick_(std::move(offer_tick)), thread_([this](const auto& stop) {
        nameThread("ticks");
        try {
          run(stop);
        } catch (const std::exception& error) {
          links_.on_failure(error);
        }
      }) {}

void TickLoop::stop() {
  thread_.request_stop();
  wake_up_.ring();
  if (thread_.joinable()) thread_.join();
  std::map<std::string, Picture> dropped;  // let go after the lock: their tickets may report
  std::lock_guard lock(mutex_);
  dropped.swap(pictures_);
}

void TickLoop::offer(const std::string& stream, const StreamInstant& newest,
                     const FrameTicketPtr& ticket) {
  Tickets released;  // let go after the lock: they may report
  {
    std::lock_guard lock(mutex_);
    noteDisplays(stream, released);
    const auto known = streams_.find(stream);
    if (known == streams_.end()) return;
    // Two threads may overtake each other.
    if (known->second.structure && known->second.structure->serial > newest.structure->serial) {
      return;
    }
    known->second = newest;
    for (auto& [key, picture] : pictures_) {
      if (!ticket || picture.display->stream != stream) continue;
      released.push_back(std::exchange(picture.ticket, ticket));
    }
  }
  wake_up_.ring();
}

void TickLoop::noteDisplays(const std::string& stream, Tickets& released) {
  const std::vector<ActiveDisplayPtr> displays = links_.broadcaster.displays(stream);
  std::erase_if(pictures_, [&](const auto& entry) {
    const Picture& picture = entry.second;
    const bool is_gone = picture.display->stream == stream &&
                         std::none_of(displays.begin(), displays.end(), [&](const auto& display) {
                           return display->picture_key == entry.first;
                         });
    if (is_gone) released.push_back(picture.ticket);
    return is_gone;
  });
  bool has_ticks = false;
  for (const ActiveDisplayPtr& display : displays) {
    if (!display->spec.temporal) continue;
    has_ticks = true;
    const OutputClock clock(display->spec.temporal->output_rate_hz, links_.clock.nowNs());
    pictures_.try_emplace(display->picture_key, Picture{display, clock, nullptr});
  }
  if (has_ticks) {
    streams_.try_emplace(stream);
  } else {
    streams_.erase(stream);
  }
}

void TickLoop::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    for (DueTick& due : takeDue()) offerTick(due);
    if (const std::optional<int64_t> due_ns = soonestNs()) {
      wake_up_.waitFor(links_.clock.napUntil(*due_ns));
    } else {
      wake_up_.wait();
    }
  }
}

// When the next tick is due; empty while there are no displays that tick.
std::optional<int64_t> TickLoop::soonestNs() {
  std::lock_guard lock(mutex_);
  std::optional<int64_t> soonest_ns;
  for (const auto& [key, picture] : pictures_) {
    soonest_ns = std::min(soonest_ns.value_or(INT64_MAX), picture.clock.dueNs());
  }
  return soonest_ns;
}

std::vector<TickLoop::DueTick> TickLoop::takeDue() {
  std::lock_guard lock(mutex_);
  std::vector<DueTick> all;
  for (auto& [key, picture] : pictures_) {
    const auto tick = picture.clock.take(links_.clock.nowNs());
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
                           .before = asksBoth(spec, newest) ? newest.before : nullptr},
                   .missed_count = tick->missed_count});
  }
  return all;
}

void TickLoop::offerTick(DueTick& due) {
  if (due.missed_count > 0) links_.metrics.output_ticks_skipped.add(double(due.missed_count));
  if (!offer_tick_(due.job, due.display)) giveBack(std::move(due.job));
}

// A ticket that goes with no atlas waits for the next tick, unless that is of a newer frame.
void TickLoop::giveBack(AtlasJob job) {
  links_.metrics.output_ticks_skipped.add();
  if (!job.ticket) return;
  std::lock_guard lock(mutex_);
  const auto picture = pictures_.find(job.picture_key);
  if (picture == pictures_.end()) return;
  if (streams_.at(picture->second.display->stream).structure->serial != job.structure->serial) {
    return;
  }
  picture->second.ticket.swap(job.ticket);  // another is let go after the lock: it may report
}

}  // namespace viewloom
