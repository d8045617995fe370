// SPDX-License-Identifier: Apache-2.0
// The jobs that wait, each for the engine that makes its picture.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.h"
#include "schedule/fair_shares.h"
#include "schedule/job_queue.h"

namespace viewloom {

// Engines are known by their rank in Engines::all. Which one makes a picture shows when it is
// planned; until then the first is asked. Thread-safety: all methods may be called from any thread.
class JobBoard {
 public:
  // Clock and shares outlive it.
  JobBoard(const Clock& clock, FairShares& shares, size_t engine_count)
      : clock_(clock), shares_(shares), lanes_(engine_count) {}

  // Outcome of an offer.
  struct Offered {
    size_t engine = 0;  // that it waits for
    // None of the picture has waited so far, or eyes have waited for these poses. Else nothing new
    // can begin: what one waits for wakes the engine's loop.
    bool is_news = false;
    std::optional<AtlasJob> replaced;  // of the same picture and an older structure
  };
  Offered offer(AtlasJob job);
  // The same, of a tick: nothing while an atlas of its picture is on its way.
  std::optional<Offered> offerUnlessBusy(const AtlasJob& job);
  // An atlas of the picture waits or is on its way.
  bool isBusy(const std::string& picture_key) const;
  // One waits to begin.
  bool isWaiting(const std::string& picture_key) const;

  // The next job that an engine may begin: one that was resumed, else one that goes before
  // everything that has begun there (FairShares). None of a payer whose eyes wait for newer poses:
  // to begin a quilt would take longer. `first_begun`: what goes first of all that has begun;
  // nullptr = nothing has. `has_room_for_eyes`: whether a tracked display of these payers may
  // begin.
  using HasRoom = std::function<bool(const Payers& payers)>;
  std::optional<AtlasJob> begin(size_t engine, const Claim* first_begun,
                                const HasRoom& has_room_for_eyes);
  // Until when tracked displays of the engine rather wait for poses, as begin() found it; of
  // several payers' the soonest.
  std::optional<int64_t> eyesWaitUntilNs(size_t engine) const;
  // A job that has begun turns out to be another engine's, and so are later ones of its picture.
  // Returns what it replaces there.
  std::optional<AtlasJob> handOver(AtlasJob job, size_t from, size_t to);
  // A job that has begun cannot be made yet: it, or a newer one of its picture, begins after
  // finish(). Returns what it replaces, or is replaced by.
  std::optional<AtlasJob> putBack(AtlasJob job, size_t engine);
  // A job that has begun can be made from now on: it is the next that the engine begins, before all
  // that have not begun.
  void resume(AtlasJob job, size_t engine);
  // The next of the picture may begin.
  void finish(const std::string& picture_key);
  // The same as JobQueue::forgetEyes.
  void forgetEyes(const std::string& picture_key);
  // Forgets which engines make pictures that none of these displays shows.
  void keepOnly(const std::vector<ActiveDisplayPtr>& displays);
  // Forgets the jobs that have not begun, or not gone on.
  std::vector<AtlasJob> clear();

 private:
  struct Lane {
    JobQueue jobs;
    std::deque<AtlasJob> resumed;
    std::map<Payers, int64_t> eyes_wait_until_ns;  // those that wait for poses
  };

  size_t engineOf(const std::string& picture_key) const;
  void enter(const Lane& lane, const AtlasJob& job);

  const Clock& clock_;
  FairShares& shares_;
  mutable std::mutex mutex_;               // guards what follows
  std::vector<Lane> lanes_;                // one an engine
  std::map<std::string, size_t> engines_;  // that pictures were planned for, but for the first
};

}  // namespace viewloom
