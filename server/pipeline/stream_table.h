// SPDX-License-Identifier: Apache-2.0
// The streams that have frames: what waits of each, and its newest structure.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "admission/memory_budget.h"
#include "base/cost_estimate.h"
#include "base/latest_mailbox.h"
#include "base/slot_pool.h"
#include "engine/engines.h"
#include "schedule/build_queue.h"
#include "schedule/fair_shares.h"
#include "schedule/frame_door.h"
#include "schedule/stream_frames.h"

namespace viewloom {

// Structures that an engine but the first may hold on to while the first goes on with newer ones:
// that of an atlas on its way, which may take seconds, and that of the next. Where it holds more,
// the stream waits.
inline constexpr uint32_t kHeldByFurtherEngine = 2;

// Thread-safety: inbox, door, slots, the claim, newest(), setNewest() and setMotion() from any
// thread; the other fields are the structure loop's, which has one thread at a time work on a
// stream.
class PipelineStream {
 public:
  PipelineStream(std::string stream_name, const Engines& engines, uint32_t least_slot_count,
                 std::function<void()> on_slot_return)
      : name(std::move(stream_name)),
        slot_count(uint32_t(least_slot_count + kHeldByFurtherEngine * (engines.all.size() - 1))),
        slots(slot_count, std::move(on_slot_return)),
        preparers(engines) {}

  // Its structure is nullptr before the first frame was built.
  StreamInstant newest() const;
  ResidentPtr resident() const { return newest().structure; }
  void setNewest(StreamInstant newest);
  void setMotion(const CameraMotion& motion);
  // One is to be built; while nobody works on the stream.
  bool hasFrame() const { return door.isOpen() && (!inbox.empty() || frames.next() != nullptr); }
  // The publisher pays for its structures.
  void notePublisher(const Payer& publisher);
  Claim claim() const;

  const std::string name;
  const uint32_t slot_count;  // without the structure before the newest
  FrameDoor door;
  LatestMailbox<OfferedFrame> inbox;  // decoded
  SlotPool<FrameForms> slots;
  StreamPreparers preparers;               // of those slots
  StreamTurn turn;                         // under the loop's mutex
  StreamFrames frames;                     // since they were taken from the inbox
  CostEstimate px_cost{kBuiltPxStart_ns};  // of a px of a frame
  std::shared_ptr<StreamRetimer> retimer;  // since a frame came in which something moves by itself

 private:
  // Until something was measured.
  static constexpr double kBuiltPxStart_ns = 30;

  mutable std::mutex mutex_;
  StreamInstant newest_;
  Payer publisher_;
};

using PipelineStreamPtr = std::shared_ptr<PipelineStream>;

// Thread-safety: all methods may be called from any thread.
class StreamTable {
 public:
  // Each stream may hold so many structures: one is traced while the next is uploaded and built.
  StreamTable(const Engines& engines, MemoryBudget& memory, uint32_t slots_per_stream,
              std::function<void()> on_slot_return);

  PipelineStreamPtr open(const std::string& name);
  // nullptr when no frame of it has come.
  PipelineStreamPtr find(const std::string& name) const;
  // Its memory goes with the last job that still reads it.
  void forget(const std::string& name);
  std::vector<PipelineStreamPtr> all() const;
  void clear();

 private:
  const Engines& engines_;
  MemoryBudget& memory_;
  const uint32_t slots_per_stream_;
  const std::function<void()> on_slot_return_;
  mutable std::mutex mutex_;
  std::map<std::string, PipelineStreamPtr> streams_;
};

}  // namespace viewloom
