// SPDX-License-Identifier: Apache-2.0
// Atlases that one engine has begun, and whose turn it is at its device.
#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "schedule/fair_shares.h"

namespace viewloom {

// `Run` has a Claim named `claim`, which does not change. Thread-safety: none; the picture loop's.
template <typename Run>
class BegunWork {
 public:
  using RunPtr = std::shared_ptr<Run>;

  // The shares outlive it.
  explicit BegunWork(const FairShares& shares) : shares_(shares) {}

  void add(RunPtr run) { runs_.push_back(std::move(run)); }
  void remove(const Run& run) {
    std::erase_if(runs_, [&](const RunPtr& begun) { return begun.get() == &run; });
  }
  void clear() { runs_.clear(); }
  bool isEmpty() const { return runs_.empty(); }
  // All that have begun.
  const std::vector<RunPtr>& all() const { return runs_; }

  // One of a tracked display of these payers.
  bool hasTracked(const Payers& payers) const {
    return std::ranges::any_of(runs_, [&](const RunPtr& run) {
      return run->claim.is_tracked && run->claim.payers == payers;
    });
  }
  // Claim of the one that goes first; nullptr = nothing has begun.
  const Claim* firstClaim() const {
    const RunPtr* const first = shares_.next(runs_, claimOfRun);
    return first == nullptr ? nullptr : &(*first)->claim;
  }
  // Makes the next part of the one that goes first. While there is no room for that, of the others
  // in their order: they make room. `make` says whether there was room for the part of a run; it
  // may remove the run. False: nothing was made.
  template <typename Make>
  bool makeNext(const Make& make) {
    std::vector<RunPtr> left = runs_;
    while (!left.empty()) {
      const auto next = left.begin() + (shares_.next(left, claimOfRun) - left.data());
      const RunPtr run = std::move(*next);
      left.erase(next);
      if (make(run)) return true;
    }
    return false;
  }

 private:
  static const Claim* claimOfRun(const RunPtr& run) { return &run->claim; }

  const FairShares& shares_;
  std::vector<RunPtr> runs_;
};

}  // namespace viewloom
