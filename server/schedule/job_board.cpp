// SPDX-License-Identifier: Apache-2.0
#include "schedule/job_board.h"

#include <algorithm>
#include <utility>

namespace viewloom {

// Jobs of one picture stay together, so that they follow each other.
size_t JobBoard::engineOf(const std::string& picture_key) const {
  for (size_t engine = 0; engine < lanes_.size(); ++engine) {
    if (lanes_[engine].jobs.isBusy(picture_key)) return engine;
  }
  const auto planned = engines_.find(picture_key);
  return planned == engines_.end() ? 0 : planned->second;
}

// A display that has waited, or is being served, keeps its place.
void JobBoard::enter(const Lane& lane, const AtlasJob& job) {
  if (!lane.jobs.isBusy(job.picture_key)) shares_.enter(claimOf(job));
}

JobBoard::Offered JobBoard::offer(AtlasJob job) {
  std::lock_guard lock(mutex_);
  Offered offered{.engine = engineOf(job.picture_key)};
  Lane& lane = lanes_[offered.engine];
  enter(lane, job);
  const Payers payers = job.payers;
  const size_t count_before = lane.jobs.waitingCount();
  offered.replaced = lane.jobs.push(std::move(job));
  const bool is_awaited = lane.eyes_wait_until_ns.contains(payers) &&
                          !lane.jobs.eyesWaitUntilNs(clock_.nowNs(), payers).has_value();
  offered.is_news = lane.jobs.waitingCount() > count_before || is_awaited;
  return offered;
}

std::optional<JobBoard::Offered> JobBoard::offerUnlessBusy(const AtlasJob& job) {
  std::lock_guard lock(mutex_);
  const size_t engine = engineOf(job.picture_key);
  if (lanes_[engine].jobs.isBusy(job.picture_key)) return std::nullopt;
  enter(lanes_[engine], job);
  lanes_[engine].jobs.push(job);
  return Offered{.engine = engine, .is_news = true, .replaced = std::nullopt};
}

bool JobBoard::isBusy(const std::string& picture_key) const {
  std::lock_guard lock(mutex_);
  return lanes_[engineOf(picture_key)].jobs.isBusy(picture_key);
}

bool JobBoard::isWaiting(const std::string& picture_key) const {
  std::lock_guard lock(mutex_);
  return lanes_[engineOf(picture_key)].jobs.isWaiting(picture_key);
}

std::optional<AtlasJob> JobBoard::begin(size_t engine, const Claim* first_begun,
                                        const HasRoom& has_room_for_eyes) {
  std::lock_guard lock(mutex_);
  Lane& lane = lanes_[engine];
  if (!lane.resumed.empty()) {
    AtlasJob job = std::move(lane.resumed.front());
    lane.resumed.pop_front();
    return job;
  }
  lane.eyes_wait_until_ns.clear();
  HeldBack held_back;
  while (const Claim* const next = lane.jobs.next(shares_, held_back)) {
    if (first_begun != nullptr && !shares_.goesBefore(*next, *first_begun)) return std::nullopt;
    if (!next->is_tracked) return lane.jobs.begin(*next);
    const Payers payers = next->payers;
    // One head of a payer at a time: who is next depends on the poses that there are when it is
    // his turn.
    if (!has_room_for_eyes(payers)) {
      held_back.tracked.insert(payers);
      continue;
    }
    const int64_t now_ns = clock_.nowNs();
    const std::optional<int64_t> until_ns = lane.jobs.eyesWaitUntilNs(now_ns, payers);
    if (!until_ns) return lane.jobs.beginTracked(now_ns, payers);
    lane.eyes_wait_until_ns.emplace(payers, *until_ns);
    held_back.all.insert(payers);
  }
  return std::nullopt;
}

std::optional<int64_t> JobBoard::eyesWaitUntilNs(size_t engine) const {
  std::lock_guard lock(mutex_);
  std::optional<int64_t> soonest_ns;
  for (const auto& [payers, until_ns] : lanes_[engine].eyes_wait_until_ns) {
    soonest_ns = std::min(soonest_ns.value_or(until_ns), until_ns);
  }
  return soonest_ns;
}

std::optional<AtlasJob> JobBoard::handOver(AtlasJob job, size_t from, size_t to) {
  std::lock_guard lock(mutex_);
  engines_[job.picture_key] = to;
  lanes_[from].jobs.finish(job.picture_key);
  std::optional<AtlasJob> newer = lanes_[from].jobs.withdraw(job.picture_key);
  lanes_[to].jobs.push(std::move(job));
  return newer ? lanes_[to].jobs.push(*std::move(newer)) : std::nullopt;
}

std::optional<AtlasJob> JobBoard::putBack(AtlasJob job, size_t engine) {
  std::lock_guard lock(mutex_);
  return lanes_[engine].jobs.push(std::move(job));
}

void JobBoard::resume(AtlasJob job, size_t engine) {
  std::lock_guard lock(mutex_);
  lanes_[engine].resumed.push_back(std::move(job));
}

void JobBoard::finish(const std::string& picture_key) {
  std::lock_guard lock(mutex_);
  for (Lane& lane : lanes_) lane.jobs.finish(picture_key);
}

void JobBoard::forgetEyes(const std::string& picture_key) {
  std::lock_guard lock(mutex_);
  for (Lane& lane : lanes_) lane.jobs.forgetEyes(picture_key);
}

void JobBoard::keepOnly(const std::vector<ActiveDisplayPtr>& displays) {
  std::lock_guard lock(mutex_);
  std::erase_if(engines_, [&](const auto& planned) {
    return std::ranges::none_of(displays, [&](const ActiveDisplayPtr& display) {
      return display->picture_key == planned.first;
    });
  });
}

std::vector<AtlasJob> JobBoard::clear() {
  std::lock_guard lock(mutex_);
  std::vector<AtlasJob> jobs;
  for (Lane& lane : lanes_) {
    for (AtlasJob& job : lane.jobs.clear()) jobs.push_back(std::move(job));
    for (AtlasJob& job : lane.resumed) jobs.push_back(std::move(job));
    lane.resumed.clear();
  }
  return jobs;
}

}  // namespace viewloom
