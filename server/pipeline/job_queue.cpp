// SPDX-License-Identifier: Apache-2.0
#include "pipeline/job_queue.h"

#include <algorithm>
#include <utility>

#include "base/check.h"

namespace viewloom {

std::optional<AtlasJob> JobQueue::push(AtlasJob job) {
  const auto same_picture = [&](const AtlasJob& waiting) {
    return waiting.picture_key == job.picture_key;
  };
  const auto older = std::find_if(waiting_.begin(), waiting_.end(), same_picture);
  if (older == waiting_.end()) {
    waiting_.push_back(std::move(job));
    return std::nullopt;
  }
  if (older->structure == job.structure) {
    if (!older->ticket) older->ticket = std::move(job.ticket);
    older->is_for_eyes &= job.is_for_eyes;
    return std::nullopt;
  }
  if (job.structure->serial < older->structure->serial) return job;
  job.deadline_ns = std::min(job.deadline_ns, older->deadline_ns);
  return std::exchange(*older, std::move(job));
}

bool JobQueue::isBusy(const std::string& picture_key) const {
  return begun_.contains(picture_key) ||
         std::any_of(waiting_.begin(), waiting_.end(),
                     [&](const AtlasJob& waiting) { return waiting.picture_key == picture_key; });
}

std::vector<AtlasJob>::const_iterator JobQueue::soonest() const {
  auto best = waiting_.end();
  for (auto job = waiting_.begin(); job != waiting_.end(); ++job) {
    if (begun_.contains(job->picture_key)) continue;
    if (best == waiting_.end() || job->deadline_ns < best->deadline_ns) best = job;
  }
  return best;
}

std::optional<int64_t> JobQueue::soonestDeadlineNs() const {
  const auto job = soonest();
  if (job == waiting_.end()) return std::nullopt;
  return job->deadline_ns;
}

bool JobQueue::hasTracked() const {
  return std::any_of(waiting_.begin(), waiting_.end(), [&](const AtlasJob& job) {
    return job.is_tracked && !begun_.contains(job.picture_key);
  });
}

AtlasJob JobQueue::begin() {
  const auto job = soonest();
  VIEWLOOM_CHECK(job != waiting_.end());
  AtlasJob taken = *job;
  waiting_.erase(job);
  begun_.insert(taken.picture_key);
  return taken;
}

void JobQueue::finish(const std::string& picture_key) {
  begun_.erase(picture_key);
}

std::vector<AtlasJob> JobQueue::clear() {
  return std::exchange(waiting_, {});
}

}  // namespace viewloom
