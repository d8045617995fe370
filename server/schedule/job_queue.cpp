// SPDX-License-Identifier: Apache-2.0
#include "schedule/job_queue.h"

#include <algorithm>
#include <utility>

#include "base/check.h"

namespace viewloom {
namespace {

PoseTimes newerOf(const PoseTimes& a, const PoseTimes& b) {
  return a.received_ns < b.received_ns ? b : a;
}

}  // namespace

std::optional<AtlasJob> JobQueue::push(AtlasJob job) {
  const auto older = std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& waiting) {
    return waiting.job.picture_key == job.picture_key;
  });
  if (older == waiting_.end()) {
    Claim claim = claimOf(job);
    waiting_.push_back({std::move(job), std::move(claim)});
    return std::nullopt;
  }
  AtlasJob& kept = older->job;
  job.poses = kept.poses = newerOf(kept.poses, job.poses);
  job.asked_ns = kept.asked_ns = std::min(kept.asked_ns, job.asked_ns);
  if (kept.structure == job.structure) {
    if (!kept.ticket) kept.ticket = std::move(job.ticket);
    kept.is_for_eyes &= job.is_for_eyes;
    addPayers(job.payers, kept.payers);
    older->claim.payers = kept.payers;
    return std::nullopt;
  }
  if (job.structure->serial < kept.structure->serial) return job;
  job.deadline_ns = std::min(job.deadline_ns, kept.deadline_ns);
  older->claim = claimOf(job);
  return std::exchange(kept, std::move(job));
}

bool JobQueue::isBusy(const std::string& picture_key) const {
  return begun_.contains(picture_key) || isWaiting(picture_key);
}

bool JobQueue::isWaiting(const std::string& picture_key) const {
  return std::any_of(waiting_.begin(), waiting_.end(), [&](const Waiting& waiting) {
    return waiting.job.picture_key == picture_key;
  });
}

bool JobQueue::mayBegin(const Waiting& waiting) const {
  return !begun_.contains(waiting.job.picture_key);
}

bool JobQueue::mayBeginTracked(const Waiting& waiting) const {
  return waiting.job.is_tracked && mayBegin(waiting);
}

template <typename Counts>
const JobQueue::Waiting* JobQueue::soonest(const Counts& counts) const {
  const Waiting* best = nullptr;
  for (const Waiting& waiting : waiting_) {
    if (!counts(waiting)) continue;
    if (best == nullptr || waiting.job.deadline_ns < best->job.deadline_ns) best = &waiting;
  }
  return best;
}

const Claim* JobQueue::next(const FairShares& shares, const HeldBack& held_back) const {
  const Waiting* const waiting =
      shares.next(waiting_, [&](const Waiting& candidate) -> const Claim* {
        const Payers& payers = candidate.claim.payers;
        const bool is_held_back =
            held_back.all.contains(payers) ||
            (candidate.claim.is_tracked && held_back.tracked.contains(payers));
        return is_held_back || !mayBegin(candidate) ? nullptr : &candidate.claim;
      });
  return waiting == nullptr ? nullptr : &waiting->claim;
}

JobQueue::NextHead JobQueue::nextHead(int64_t now_ns, const Payers& payers) const {
  const auto counts = [&](const Waiting& waiting) {
    return mayBeginTracked(waiting) && waiting.claim.payers == payers;
  };
  MovingHeads heads(now_ns);
  for (const Waiting& waiting : waiting_) {
    if (counts(waiting)) heads.add(waiting.job.poses);
  }
  const auto passed_count_max = kRoundsPassed * size_t(heads.count());
  const Waiting* next = soonest([&](const Waiting& waiting) {
    const size_t passed_count = waiting.passed_count;
    return counts(waiting) && passed_count >= passed_count_max &&
           (passed_count >= passed_count_max + size_t(heads.count()) ||
            heads.areAtHand(waiting.job.poses));
  });
  if (next == nullptr) {
    next = soonest([&](const Waiting& waiting) {
      return counts(waiting) && heads.areTimely(waiting.job.poses);
    });
  }
  if (next != nullptr) return {next, heads.waitForUntilNs(next->job.poses)};
  next = soonest([&](const Waiting& waiting) {
    return counts(waiting) && heads.areNewest(waiting.job.poses);
  });
  return {next, heads.waitForAnyUntilNs()};
}

std::optional<int64_t> JobQueue::eyesWaitUntilNs(int64_t now_ns, const Payers& payers) const {
  const NextHead next = nextHead(now_ns, payers);
  const bool may_wait = next.waiting != nullptr && next.waiting->job.is_for_eyes;
  return may_wait ? next.wait_until_ns : std::nullopt;
}

AtlasJob JobQueue::take(const Waiting* waiting) {
  VIEWLOOM_CHECK(waiting != nullptr);
  AtlasJob taken = waiting->job;
  waiting_.erase(waiting_.begin() + (waiting - waiting_.data()));
  begun_.insert(taken.picture_key);
  return taken;
}

AtlasJob JobQueue::begin(const Claim& claim) {
  const auto found = std::ranges::find(
      waiting_, claim.display, [](const Waiting& waiting) { return waiting.job.picture_key; });
  return take(found == waiting_.end() ? nullptr : &*found);
}

AtlasJob JobQueue::beginTracked(int64_t now_ns, const Payers& payers) {
  AtlasJob taken = take(nextHead(now_ns, payers).waiting);
  for (Waiting& waiting : waiting_) {
    waiting.passed_count += mayBeginTracked(waiting) && waiting.claim.payers == payers ? 1 : 0;
  }
  return taken;
}

void JobQueue::finish(const std::string& picture_key) {
  begun_.erase(picture_key);
}

void JobQueue::forgetEyes(const std::string& picture_key) {
  std::erase_if(waiting_, [&](const Waiting& waiting) {
    return waiting.job.picture_key == picture_key && waiting.job.is_for_eyes;
  });
}

std::optional<AtlasJob> JobQueue::withdraw(const std::string& picture_key) {
  const auto found = std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& waiting) {
    return waiting.job.picture_key == picture_key;
  });
  if (found == waiting_.end()) return std::nullopt;
  AtlasJob job = std::move(found->job);
  waiting_.erase(found);
  return job;
}

std::vector<AtlasJob> JobQueue::clear() {
  std::vector<AtlasJob> jobs;
  for (Waiting& waiting : std::exchange(waiting_, {})) jobs.push_back(std::move(waiting.job));
  return jobs;
}

}  // namespace viewloom
