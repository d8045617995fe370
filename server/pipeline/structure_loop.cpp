// SPDX-License-Identifier: Apache-2.0
#include "pipeline/structure_loop.h"

#include <utility>

#include "base/log.h"
#include "base/thread_name.h"
#include "pipeline/stream_retimer.h"
#include "pipeline/within_memory.h"

namespace viewloom {
namespace {

// Description of a structure from the frame alone.
ResidentStructure describe(const Frame& frame) {
  ResidentStructure structure;
  structure.frame_number = frame.format.number;
  structure.capture_time_ns = frame.format.capture_time_ns;
  structure.times = frame.times;
  for (const SourceFormat& source : frame.format.sources) {
    structure.sources.push_back(seenSource(source));
  }
  return structure;
}

}  // namespace

StructureLoop::StructureLoop(const PipelineLinks& links, StreamTable& streams,
                             const FrameBuilder& builder, WakeUp& wake_up, OnResident on_resident)
    : links_(links),
      streams_(streams),
      builder_(builder),
      wake_up_(wake_up),
      on_resident_(std::move(on_resident)),
      thread_([this](const std::stop_token& stop) {
        nameThread("build");
        try {
          run(stop);
        } catch (const std::exception& error) {
          links_.on_failure(error);
        }
      }) {}

void StructureLoop::stop() {
  thread_.request_stop();
  wake_up_.ring();
  if (thread_.joinable()) thread_.join();
}

void StructureLoop::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    bool is_idle = true;
    const absl::Status status = withinMemory([&] {
      for (const PipelineStreamPtr& stream : streams_.all()) {
        if (!stop.stop_requested() && serve(*stream)) is_idle = false;
      }
    });
    if (!status.ok()) log(LogLevel::kWarning, "no memory is left to look for frames");
    if (is_idle) wake_up_.wait();
  }
}

// One frame of the stream; false when there is none or no slot for it.
bool StructureLoop::serve(PipelineStream& stream) {
  if (auto newest = stream.inbox.take()) {
    const auto replaced = stream.frames.offer(*std::move(newest));
    if (replaced) links_.metrics.replaced[HandOver::kStructure].add();
    if (dropUnchanged(stream)) return true;
  }
  const OfferedFrame* const next = stream.frames.next();
  if (next == nullptr) return false;
  std::shared_ptr<FrameForms> slot;
  const absl::Status has_slot = withinMemory([&] { slot = takeSlot(stream, next->frame); });
  if (has_slot.ok() && !slot) return false;
  OfferedFrame offered = stream.frames.takeNext();
  const FrameTicketPtr ticket = offered.ticket;
  const absl::Status status =
      has_slot.ok() ? withinMemory([&] { build(stream, std::move(offered), std::move(slot)); })
                    : has_slot;
  if (status.ok()) return true;
  log(LogLevel::kWarning, "stream ", stream.name, ": a frame is refused: ", status.message());
  ticket->noteRefused(std::string(status.message()));
  return true;
}

// A camera that stood since the last frame moves no more: only then is there something to tell.
bool StructureLoop::dropUnchanged(PipelineStream& stream) const {
  const ResidentPtr resident = stream.resident();
  if (!resident) return false;
  const auto motion = stream.frames.followUnchanged(*resident, links_.clock.nowNs());
  if (!motion) return false;
  links_.metrics.frames_unchanged.add();
  const bool was_moving = stream.newest().motion.isMoving();
  stream.setMotion(*motion);
  stream.frames.takeNext().ticket->noteUnchanged(resident->stats);
  if (was_moving) on_resident_(stream, nullptr);
  return true;
}

bool StructureLoop::isInterpolated(const PipelineStream& stream) const {
  return showBetweenFrames(links_.broadcaster.displays(stream.name));
}

std::shared_ptr<FrameForms> StructureLoop::takeSlot(PipelineStream& stream,
                                                    const FramePtr& frame) const {
  stream.slots.setCountMax(stream.slot_count + (isInterpolated(stream) ? 1 : 0));
  return builder_.takeSlot(stream.slots, stream.preparers, frame);
}

void StructureLoop::build(PipelineStream& stream, OfferedFrame offered,
                          std::shared_ptr<FrameForms> slot) {
  auto structure = std::make_shared<ResidentStructure>(describe(*offered.frame));
  structure->stream = stream.name;
  structure->serial = ++last_serial_;
  builder_.build(*offered.frame, std::move(slot), *structure);
  takeDefaults(stream, offered, *structure);
  if (movesByItself(*offered.frame)) {
    if (!stream.retimer) stream.retimer = std::make_shared<StreamRetimer>(links_, builder_);
    structure->moving_frame = offered.frame;
    structure->retimer = stream.retimer;
  }

  count(*structure, *offered.frame);
  stream.setNewest(stream.frames.becomeResident(std::move(offered.frame), std::move(structure),
                                                stream.resident(), isInterpolated(stream)));
  on_resident_(stream, std::move(offered.ticket));
}

// Defaults of the stream; tells where they are others now.
void StructureLoop::takeDefaults(PipelineStream& stream, const OfferedFrame& offered,
                                 ResidentStructure& structure) {
  const auto note = stream.frames.takeDefaults(offered.session, structure);
  if (!note) return;
  log(LogLevel::kInfo, "stream ", stream.name, ": ", *note);
  if (structure.taking.reason == DefaultsReason::kDepthMoved) offered.ticket->say(*note);
}

void StructureLoop::count(const ResidentStructure& structure, const Frame& frame) const {
  const FrameTimes& times = structure.times;
  links_.metrics.structures_built.add();
  links_.metrics.observeStage(Stage::kReceive, times.last_chunk_ns - times.first_chunk_ns);
  links_.metrics.observeStage(Stage::kDecode, times.decoded_ns - times.last_chunk_ns);
  links_.metrics.observeStage(Stage::kUpload, structure.upload_ns);
  links_.metrics.observeStage(Stage::kBuild, structure.build_ns);
  links_.directory.noteResident(structure.stream, structure.frame_number,
                                structure.defaults.source_size_px,
                                uint32_t(frame.sources.front().size()), structure.stats);
}

}  // namespace viewloom
