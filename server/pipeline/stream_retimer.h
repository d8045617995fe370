// SPDX-License-Identifier: Apache-2.0
// Structures of a stream's frames as they are for times between frames: what moves by itself has
// gone on.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <stop_token>

#include "admission/memory_budget.h"
#include "base/cost_estimate.h"
#include "pipeline/frame_builder.h"
#include "retime/frame_retimer.h"
#include "schedule/atlas_job.h"
#include "schedule/fair_shares.h"

namespace viewloom {

// A retiming that some claim asks for, and pays for.
struct RetimeOrder {
  FairShares& shares;
  Claim claim;
  std::function<bool()> is_given_up;  // from any thread
};

// Each time is built once, for all displays that show it one after the other. Memory is bounded by
// kSlotCount structures. Thread-safety: none; the retime loop has one job of a stream at a time.
class StreamRetimer {
 public:
  StreamRetimer(const PipelineLinks& links, const FrameBuilder& builder);

  // Which of the two newest frames a structure is of.
  enum class Which : uint8_t { kNewest, kBefore };

  // The structure with everything that moves carried on for so long, or back; what was not carried
  // is handed back as it is, and so is what the device has no room for. nullptr: all slots are
  // lent. Throws PreparationGivenUp once that is asked.
  ResidentPtr carried(const ResidentPtr& structure, int64_t carried_ns, Which which,
                      Guesses guesses, const RetimeOrder& order);

 private:
  // The last one of its kind.
  struct Carried {
    Reservation memory{};  // of the retimer, and of what it makes
    FrameRetimer retimer;
    uint64_t serial = 0;
    int64_t carried_ns = 0;
    Guesses guesses = Guesses::kStand;
    ResidentPtr structure;
  };
  // One slot of each kind is traced while the next is built.
  static constexpr size_t kSlotCount = 4;
  // Until something was measured.
  static constexpr double kRetimedPxStart_ns = 60;

  // False = the budget has no room.
  bool makeRoom(const Frame& frame, Carried& carried) const;
  ResidentPtr build(const ResidentStructure& structure, int64_t carried_ns, Guesses guesses,
                    FrameRetimer& retimer, const RetimeOrder& order);

  const PipelineLinks& links_;
  const FrameBuilder& builder_;
  SlotPool<FrameForms> slots_{kSlotCount, [] {}};
  StreamPreparers preparers_;
  std::array<Carried, 2> carried_;
  CostEstimate px_cost_{kRetimedPxStart_ns};  // of a px of a frame
};

// Gives the job of a tick the structures of the time that is shown. Its payers pay for them. False
// while there is no room, and once the stop is requested.
bool showAsOfTick(AtlasJob& job, FairShares& shares, const std::stop_token& stop);

}  // namespace viewloom
