// SPDX-License-Identifier: Apache-2.0
// Turns the newest frame of each stream into its resident structure, in fair shares.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "pipeline/change_bell.h"
#include "pipeline/frame_builder.h"
#include "pipeline/pipeline_links.h"
#include "pipeline/stream_table.h"
#include "schedule/job_board.h"

namespace viewloom {

// A form that an engine needs of a resident frame, for a picture of this claim. `then` is told on a
// thread of the loop how it went; not at all when the loop stops.
struct FormOrder {
  ResidentPtr structure;
  size_t engine = 0;
  Claim claim;
  std::function<void(const absl::Status& status)> then;
};

// Takes a frame, unless it is the resident one once more, gives it the form that its first engine
// takes it in, makes it resident. Meanwhile pictures are made of what is resident already. Of one
// stream one frame is built at a time.
//
// Two threads: one builds anything, the other only what takes no longer than 50 ms. So a
// stream of huge frames stops no other. Thread-safety: all methods may be called from any thread;
// stop() from one, once.
class StructureLoop {
 public:
  // `on_resident` is called on a thread of the loop, for one frame of a stream at a time; the
  // ticket is of the structure's frame.
  using OnResident = std::function<void(const PipelineStream& stream, FrameTicketPtr ticket)>;

  // Parts that are used and outlive it.
  struct Links {
    const PipelineLinks& pipeline;
    StreamTable& streams;
    const FrameBuilder& builder;
    const JobBoard& board;
    FairShares& shares;
    // Rung when a frame was offered, a slot came back, displays came or went, an atlas has begun.
    ChangeBell& bell;
  };

  // `on_served`: called after each look at a frame of a stream, whatever became of it.
  using OnServed = std::function<void(const std::string& stream)>;

  StructureLoop(const Links& links, OnResident on_resident, OnServed on_served);
  ~StructureLoop() { stop(); }

  void prepareForm(FormOrder order);

  // Gives up the frames in hand; frames that wait are left to be reported as replaced.
  void stop();

 private:
  enum class Lane : uint8_t { kAny, kShort };  // of the threads
  enum class Outcome : uint8_t { kServed, kNothing, kNoSlot, kTooLong };
  // A build that may begin: the next frame of a stream, or a form.
  struct Work {
    Claim claim;
    PipelineStreamPtr stream = nullptr;  // nullptr = a form
    FormOrder form;
  };
  // A look at the streams, and its outcome.
  struct Look {
    Lane lane = Lane::kAny;
    uint64_t change_count = 0;        // of the bell, before it
    std::optional<int64_t> until_ns;  // when to look again; empty = when something changes
  };

  void run(Lane lane, const std::stop_token& stop);
  // Takes the next build, of those that may begin.
  std::optional<Work> take(Look& look);
  void addStreams(Look& look, std::vector<Work>& works);
  void serve(Work work, const Look& look, const std::stop_token& stop);
  StreamDemand demandOf(const PipelineStream& stream) const;

  Outcome serveStream(PipelineStream& stream, Lane lane, const std::stop_token& stop);
  void serveForm(const FormOrder& order, const std::stop_token& stop);
  bool dropUnchanged(PipelineStream& stream) const;
  bool isInterpolated(const PipelineStream& stream) const;
  std::shared_ptr<FrameForms> takeSlot(PipelineStream& stream, const FramePtr& frame) const;
  void build(PipelineStream& stream, OfferedFrame offered, std::shared_ptr<FrameForms> slot,
             const std::stop_token& stop);
  PreparationEvents eventsFor(const Claim& claim, const std::stop_token& stop) const;
  static void takeDefaults(PipelineStream& stream, const OfferedFrame& offered,
                           ResidentStructure& structure);
  void count(const ResidentStructure& structure, const Frame& frame) const;

  const Links links_;
  const OnResident on_resident_;
  const OnServed on_served_;
  CostEstimate form_px_cost_;
  std::atomic<uint64_t> last_serial_ = 0;
  std::mutex mutex_;                                 // guards what follows
  std::vector<FormOrder> forms_;                     // that wait
  std::set<const ResidentStructure*> form_in_hand_;  // structures, of which one is prepared
  std::vector<std::jthread> threads_;                // last: they use all of the above
};

}  // namespace viewloom
