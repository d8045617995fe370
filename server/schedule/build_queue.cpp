// SPDX-License-Identifier: Apache-2.0
#include "schedule/build_queue.h"

#include <algorithm>
#include <utility>

namespace viewloom {

bool StreamTurn::mayBeTaken(BuildLane lane, uint64_t change_count) const {
  if (is_in_hand_ || is_awaited_ || served_in_vain_ == change_count) return false;
  return lane == BuildLane::kAny || !takes_long_;
}

void StreamTurn::giveBack(BuildOutcome outcome, uint64_t change_count) {
  is_in_hand_ = false;
  takes_long_ = outcome == BuildOutcome::kTooLong;
  served_in_vain_.reset();
  if (outcome == BuildOutcome::kNoSlot) served_in_vain_ = change_count;
}

BuildQueue::Next BuildQueue::take(const Look& look, std::span<const StreamBuild> streams) {
  Next next;
  std::vector<Claim> stream_claims(streams.size());
  std::vector<const Claim*> claims(streams.size(), nullptr);
  for (size_t i = 0; i < streams.size(); ++i) {
    const StreamBuild& stream = streams[i];
    if (!stream.turn->mayBeTaken(look.lane, look.change_count)) continue;
    if (stream.has_waiting()) {
      const auto until_ns = stream.turn->waitUntilNs(stream.demand(), look.now_ns);
      if (!until_ns) next.let_in.push_back(i);
      if (until_ns) next.until_ns = std::min(next.until_ns.value_or(*until_ns), *until_ns);
    }
    if (!stream.has_frame()) continue;
    stream_claims[i] = stream.claim();
    claims[i] = &stream_claims[i];
  }
  for (const FormOrder& form : forms_) {
    const bool may_begin =
        !in_hand_.contains(form.structure.get()) && takes(look.lane, predictNs(form));
    claims.push_back(may_begin ? &form.claim : nullptr);
  }
  const std::optional<size_t> first = shares_.nextOf(claims);
  if (!first) return next;
  if (*first < streams.size()) {
    streams[*first].turn->take();
    next.stream = first;
    return next;
  }
  const auto form = forms_.begin() + std::ptrdiff_t(*first - streams.size());
  in_hand_.insert(form->structure.get());
  next.form = std::move(*form);
  forms_.erase(form);
  return next;
}

}  // namespace viewloom
