// SPDX-License-Identifier: Apache-2.0
// Which structure is built next: of the next frame of a stream, or a form of a resident frame that
// an engine needs.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include <absl/status/status.h>

#include "base/cost_estimate.h"
#include "schedule/build_gate.h"
#include "schedule/fair_shares.h"
#include "schedule/resident_structure.h"

namespace viewloom {

// Threads that build: some take anything, the others only builds of up to kShortBuild_ns, so that a
// stream of huge frames stops no other.
enum class BuildLane : uint8_t { kAny, kShort };
inline constexpr int64_t kShortBuild_ns = 50'000'000;

// Whether threads of this lane take builds of such a predicted time.
constexpr bool takes(BuildLane lane, int64_t predicted_ns) {
  return lane == BuildLane::kAny || predicted_ns <= kShortBuild_ns;
}

// Outcome of a thread's look at the next frame of a stream.
enum class BuildOutcome : uint8_t {
  kServed,    // built, refused, or nothing new
  kNothing,   // there is no frame
  kNoSlot,    // all slots are lent: nothing can be done until something changes
  kNotReady,  // an engine lacks what it needs for it (StreamTurn::awaitReady)
  kTooLong    // the thread's lane does not take it
};

// State of one stream between its builds: one thread at a time works on it. Thread-safety: none.
class StreamTurn {
 public:
  // Whether a thread of this lane may take it. `change_count`: of changes so far that may have made
  // room (ChangeBell).
  bool mayBeTaken(BuildLane lane, uint64_t change_count) const;
  // When the next frame may be built unasked; empty = at once. Only while none was let in, or
  // nobody works on the stream.
  std::optional<int64_t> waitUntilNs(const StreamDemand& demand, int64_t now_ns) const {
    return gate_.waitUntilNs(demand, now_ns);
  }
  void take() { is_in_hand_ = true; }
  // `change_count`: from before the look.
  void giveBack(BuildOutcome outcome, uint64_t change_count);
  // Nobody may take it from now on until noteReady().
  void awaitReady() { is_awaited_ = true; }
  void noteReady() { is_awaited_ = false; }
  // See BuildGate. By whoever works on the stream.
  void noteBuilt(const StreamDemand& demand, int64_t now_ns) { gate_.noteBuilt(demand, now_ns); }

 private:
  bool is_in_hand_ = false;
  bool is_awaited_ = false;                 // an engine prepares what it lacks
  bool takes_long_ = false;                 // its next frame does
  std::optional<uint64_t> served_in_vain_;  // change that was the last when there was no slot
  BuildGate gate_;
};

// A form that an engine needs of a resident frame, for a picture of this claim. `then` is told on
// the thread that made it how it went; not at all when the server stops.
struct FormOrder {
  ResidentPtr structure;
  size_t engine = 0;
  Claim claim;
  uint64_t px_count = 0;  // that its time is predicted from
  std::function<void(const absl::Status& status)> then;
};

// Thread-safety: none.
class BuildQueue {
 public:
  // The shares outlive it.
  explicit BuildQueue(const FairShares& shares) : shares_(shares) {}

  // A stream. The functions are called where its turn lets it be taken.
  struct StreamBuild {
    StreamTurn* turn = nullptr;
    std::function<bool()> has_frame;    // that was let in (FrameDoor)
    std::function<bool()> has_waiting;  // that was not
    std::function<StreamDemand()> demand;
    std::function<Claim()> claim;
  };
  // A thread's look for something to build.
  struct Look {
    BuildLane lane = BuildLane::kAny;
    uint64_t change_count = 0;
    int64_t now_ns = 0;
  };
  // A stream or a form; neither = none may be built.
  struct Next {
    std::vector<size_t> let_in;    // streams whose waiting frames may come in unasked
    std::optional<size_t> stream;  // place among the streams
    std::optional<FormOrder> form;
    std::optional<int64_t> until_ns;  // when to look again; empty = when something changes
  };

  void push(FormOrder form) { forms_.push_back(std::move(form)); }
  // Takes what goes first in fair shares, of what may begin. Streams go before forms of equal
  // claims, and in their order. Of one structure, one form is made at a time.
  Next take(const Look& look, std::span<const StreamBuild> streams);
  // The form that was taken is made, or given up.
  void finish(const FormOrder& form) { in_hand_.erase(form.structure.get()); }

  int64_t predictNs(const FormOrder& form) const { return form_px_cost_.predictNs(form.px_count); }
  void noteMade(const FormOrder& form, int64_t measured_ns) {
    form_px_cost_.note(form.px_count, measured_ns);
  }

 private:
  // Time of a px of a form until something was measured.
  static constexpr double kFormPxStart_ns = 30;

  const FairShares& shares_;
  CostEstimate form_px_cost_{kFormPxStart_ns};
  std::vector<FormOrder> forms_;                // that wait
  std::set<const ResidentStructure*> in_hand_;  // of which a form is being made
};

}  // namespace viewloom
