// SPDX-License-Identifier: Apache-2.0
// Turns the newest frame of each stream into its resident structure.
#pragma once

#include <functional>
#include <thread>

#include "pipeline/frame_builder.h"
#include "pipeline/pipeline_links.h"
#include "pipeline/stream_table.h"
#include "pipeline/wake_up.h"

namespace viewloom {

// One thread: takes a frame, unless it is the resident one once more, gives it the form that its
// first engine takes it in, makes it resident. Meanwhile pictures are made of what is resident
// already. Thread-safety: stop() from one thread, once.
class StructureLoop {
 public:
  // `on_resident` is called on the loop's thread; the ticket is of the structure's frame.
  using OnResident = std::function<void(const PipelineStream& stream, FrameTicketPtr ticket)>;

  // `wake_up` is rung when a frame was offered or a slot came back.
  StructureLoop(const PipelineLinks& links, StreamTable& streams, const FrameBuilder& builder,
                WakeUp& wake_up, OnResident on_resident);
  ~StructureLoop() { stop(); }

  // Finishes the frame in hand; frames that wait are left to be reported as replaced.
  void stop();

 private:
  void run(const std::stop_token& stop);
  bool serve(PipelineStream& stream);
  bool dropUnchanged(PipelineStream& stream) const;
  bool isInterpolated(const PipelineStream& stream) const;
  std::shared_ptr<FrameForms> takeSlot(PipelineStream& stream, const FramePtr& frame) const;
  void build(PipelineStream& stream, OfferedFrame offered, std::shared_ptr<FrameForms> slot);
  static void takeDefaults(PipelineStream& stream, const OfferedFrame& offered,
                           ResidentStructure& structure);
  void count(const ResidentStructure& structure, const Frame& frame) const;

  const PipelineLinks& links_;
  StreamTable& streams_;
  const FrameBuilder& builder_;
  WakeUp& wake_up_;
  const OnResident on_resident_;
  uint64_t last_serial_ = 0;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace viewloom
