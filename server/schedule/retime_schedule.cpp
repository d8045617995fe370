// SPDX-License-Identifier: Apache-2.0
#include "schedule/retime_schedule.h"

#include <algorithm>
#include <utility>

namespace viewloom {
namespace {

// Whether one picture serves both jobs.
bool showTheSame(const AtlasJob& a, const AtlasJob& b) {
  return a.structure == b.structure && a.before == b.before &&
         a.tick->shown.carried_ns == b.tick->shown.carried_ns;
}

}  // namespace

bool isRetimed(const AtlasJob& job) {
  return job.structure->retimer && (job.before || job.tick->shown.carried_ns != 0);
}

RetimeDates retimeDatesOf(const AtlasJob& job) {
  RetimeDates dates{.newest_ns = job.tick->shown.carried_ns, .before_ns = {}};
  // The frame before counts only if it moves, too.
  if (job.before && job.before->retimer) {
    dates.before_ns = dates.newest_ns + job.tick->frames_apart_ns;
  }
  return dates;
}

RetimeSchedule::Offered RetimeSchedule::offer(AtlasJob&& job, const ActiveDisplayPtr& display) {
  Stream& stream = streams_[job.structure->stream];
  if (stream.in_hand && stream.in_hand->picture_key == job.picture_key) return {};
  const auto older = std::ranges::find_if(stream.waiting, [&](const Tick& waiting) {
    return waiting.job.picture_key == job.picture_key;
  });
  if (older == stream.waiting.end()) {
    stream.waiting.push_back({std::move(job), display});
    return {.is_taken = true, .replaced = {}};
  }
  if (stream.in_hand && showTheSame(older->job, *stream.in_hand)) return {};
  if (!job.ticket) job.ticket = std::move(older->job.ticket);
  return {.is_taken = true, .replaced = std::exchange(*older, {std::move(job), display})};
}

bool RetimeSchedule::isBusy(const AtlasJob& job) const {
  const auto stream = streams_.find(job.structure->stream);
  if (stream == streams_.end()) return false;
  const auto& [waiting, in_hand] = stream->second;
  return (in_hand && in_hand->picture_key == job.picture_key) ||
         std::ranges::any_of(
             waiting, [&](const Tick& tick) { return tick.job.picture_key == job.picture_key; });
}

std::optional<RetimeSchedule::Tick> RetimeSchedule::take() {
  const auto found = std::ranges::find_if(streams_, [](const auto& entry) {
    return !entry.second.in_hand && !entry.second.waiting.empty();
  });
  if (found == streams_.end()) return std::nullopt;
  Stream& stream = found->second;
  Tick tick = std::move(stream.waiting.front());
  stream.waiting.erase(stream.waiting.begin());
  stream.in_hand = tick.job;
  stream.in_hand->ticket = nullptr;
  return tick;
}

std::optional<AtlasJob> RetimeSchedule::finish(const std::string& name) {
  Stream& stream = streams_.at(name);
  std::optional<AtlasJob> served = std::exchange(stream.in_hand, std::nullopt);
  if (stream.waiting.empty()) streams_.erase(name);
  return served;
}

}  // namespace viewloom
