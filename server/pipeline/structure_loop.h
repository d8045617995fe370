// SPDX-License-Identifier: Apache-2.0
// Turns the frames of each stream that were let in into its resident structure, in fair shares.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "pipeline/change_bell.h"
#include "pipeline/frame_builder.h"
#include "pipeline/pipeline_links.h"
#include "pipeline/stream_table.h"
#include "schedule/build_queue.h"
#include "schedule/job_board.h"

namespace viewloom {

// Takes a frame, unless it is the resident one once more, gives it the form that its first engine
// takes it in, makes it resident. Meanwhile pictures are made of what is resident already. Of one
// stream one frame is built at a time.
//
// Two threads, one of each BuildLane; BuildQueue says what they build next. Thread-safety: all
// methods may be called from any thread; stop() from one, once.
class StructureLoop {
 public:
  // Called on the loop's threads.
  struct Events {
    // For one frame of a stream at a time; the ticket is of the structure's frame.
    std::function<void(const PipelineStream& stream, FrameTicketPtr ticket)> on_resident;
    // After each look at a frame of a stream, whatever became of it.
    std::function<void(PipelineStream& stream)> on_served;
    // The waiting frame of a stream is to come in although no picture has asked for it.
    std::function<void(PipelineStream& stream)> let_in;
  };

  // Parts that are used and outlive it.
  struct Links {
    const PipelineLinks& pipeline;
    StreamTable& streams;
    const FrameBuilder& builder;
    const JobBoard& board;
    FairShares& shares;
    // Rung when a frame waits or has come in, a slot came back, displays came or went, an atlas has
    // begun.
    ChangeBell& bell;
  };

  StructureLoop(const Links& links, Events events);
  ~StructureLoop() { stop(); }

  // Whether a frame that waits now is built although no picture has asked for it.
  bool takesUnasked(const PipelineStream& stream);

  void prepareForm(FormOrder order);

  // Gives up the frames in hand; frames that wait are left to be reported as replaced.
  void stop();

 private:
  // A build that a thread has taken, if any.
  struct Work {
    PipelineStreamPtr stream = nullptr;
    std::optional<FormOrder> form = std::nullopt;
    std::vector<PipelineStreamPtr> let_in = {};
    std::optional<int64_t> until_ns = std::nullopt;  // as BuildQueue::Next
  };

  void run(BuildLane lane, const std::stop_token& stop);
  Work take(const BuildQueue::Look& look);
  void serve(const PipelineStreamPtr& stream, const BuildQueue::Look& look,
             const std::stop_token& stop);
  void serve(const FormOrder& form, const std::stop_token& stop);
  StreamDemand demandOf(const PipelineStream& stream) const;

  BuildOutcome buildNext(const PipelineStreamPtr& stream, BuildLane lane,
                         const std::stop_token& stop);
  // Whether the frame can be prepared at once. Else the stream is left until it can.
  bool isReadyFor(const Frame& frame, const PipelineStreamPtr& stream);
  void make(const FormOrder& order, const std::stop_token& stop);
  bool dropUnchanged(PipelineStream& stream) const;
  bool isInterpolated(const PipelineStream& stream) const;
  std::shared_ptr<FrameForms> takeSlot(PipelineStream& stream, const FramePtr& frame) const;
  void build(PipelineStream& stream, OfferedFrame offered, std::shared_ptr<FrameForms> slot,
             const std::stop_token& stop);
  static void takeDefaults(PipelineStream& stream, const OfferedFrame& offered,
                           ResidentStructure& structure);
  void count(const ResidentStructure& structure, const Frame& frame) const;

  const Links links_;
  const Events events_;
  std::atomic<uint64_t> last_serial_ = 0;
  std::mutex mutex_;                   // guards what follows, and the turns of streams
  BuildQueue queue_;                   // its costs are anybody's
  std::vector<std::jthread> threads_;  // last: they use all of the above
};

}  // namespace viewloom
