// SPDX-License-Identifier: Apache-2.0
// Which atlas is begun next: of whoever has had the smaller share, the newest structure of each
// picture; of tracked displays one whose eyes have just moved.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "schedule/atlas_job.h"
#include "schedule/fair_shares.h"
#include "schedule/moving_heads.h"

namespace viewloom {

// How often all tracked displays may go before one that waits, which then is next. Of eight heads
// that move at random times, 2.4 of them answered in an interval of 90 Hz, none is passed over more
// than 26 times with 3, and 42 with 5, which makes no p99 of the age of poses any better
// (answered_heads_test: 2.1 ms in the median of 50 sets).
inline constexpr uint32_t kRoundsPassed = 3;

// Payers whose jobs do not begin for now: all of them, or those of tracked displays.
struct HeldBack {
  std::set<Payers> all;
  std::set<Payers> tracked;
};

// Jobs that have not begun, at most one per picture.
//
// FairShares says which job is next. Where that is one of a tracked display, another tracked
// display of the same payer may be next instead: when more heads move than there are answers for,
// not all poses get one, and who is next decides how old those are that do. Of heads whose poses
// came just now, or are just about to (MovingHeads), the one with the soonest deadline is next: it
// has waited longest, and waits for its poses. Else it is whoever's poses come next, if that is
// soon, or one whose are the newest. Of n heads that wait, one that others have gone before
// kRoundsPassed * n times is next as soon as its poses are at hand, and after n more in any case.
// So none is passed over more than (kRoundsPassed + 2) * n - 1 times: the n - 1 others may be as
// late.
//
// Thread-safety: none.
class JobQueue {
 public:
  // Merges two jobs for the same picture: the newer structure stays and takes the sooner deadline,
  // so that a picture with ever newer structures is not put off for ever. The other job is
  // returned. With the same structure the two become one.
  std::optional<AtlasJob> push(AtlasJob job);

  size_t waitingCount() const { return waiting_.size(); }
  // A job of the picture waits, or has begun.
  bool isBusy(const std::string& picture_key) const;
  bool isWaiting(const std::string& picture_key) const;

  // Claim of the job that is next, of those that are not held back; nullptr = none may begin.
  // None may while its picture is being traced.
  const Claim* next(const FairShares& shares, const HeldBack& held_back = {}) const;
  // Until when tracked displays of a payer rather wait for poses that are due than begin; empty =
  // they do not. One that is next and has a new frame to see never does.
  std::optional<int64_t> eyesWaitUntilNs(int64_t now_ns, const Payers& payers = {}) const;
  // Takes the job of a claim that next() gave, or of tracked displays of a payer the one that is
  // next by now; no other of its picture may begin until finish().
  AtlasJob begin(const Claim& claim);
  AtlasJob beginTracked(int64_t now_ns, const Payers& payers = {});
  void finish(const std::string& picture_key);
  // An atlas on its way is seen by the newest eyes: a job for these alone is none any more, and
  // nobody is to wait for what it would.
  void forgetEyes(const std::string& picture_key);
  // Takes the job of the picture that has not begun, if there is one.
  std::optional<AtlasJob> withdraw(const std::string& picture_key);
  // Forgets the jobs that have not begun.
  std::vector<AtlasJob> clear();

 private:
  struct Waiting {
    AtlasJob job;
    Claim claim;              // of the job
    size_t passed_count = 0;  // of tracked displays that have begun before it, and might not have
  };

  // Tracked displays that may begin, if there are any.
  struct NextHead {
    const Waiting* waiting = nullptr;
    std::optional<int64_t> wait_until_ns;  // rather than begin at once
  };

  bool mayBegin(const Waiting& waiting) const;
  bool mayBeginTracked(const Waiting& waiting) const;
  // The one of those that count with the soonest deadline; nullptr = none.
  template <typename Counts>
  const Waiting* soonest(const Counts& counts) const;
  NextHead nextHead(int64_t now_ns, const Payers& payers) const;
  AtlasJob take(const Waiting* waiting);

  std::vector<Waiting> waiting_;
  std::set<std::string> begun_;
};

}  // namespace viewloom
