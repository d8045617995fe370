// SPDX-License-Identifier: Apache-2.0
#include "pipeline/structure_loop.h"

#include <algorithm>
#include <utility>

#include "base/log.h"
#include "base/str_cat.h"
#include "base/thread_name.h"
#include "frame/same_content.h"
#include "pipeline/stream_retimer.h"

namespace viewloom {
namespace {

TrackedFrame trackedFrame(const Frame& frame, const Frame* before, const SourceStats& stats,
                          int64_t now_ns) {
  TrackedFrame tracked = trackedFrame(frame, before, stats.inv_z_near);
  tracked.arrived_ns = frame.times.first_chunk_ns;
  tracked.built_ns = now_ns;
  return tracked;
}

// What the frame itself says.
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
    for (const PipelineStreamPtr& stream : streams_.all()) {
      if (!stop.stop_requested() && serve(*stream)) is_idle = false;
    }
    if (is_idle) wake_up_.wait();
  }
}

// One frame of the stream; false when there is none or no slot for it.
bool StructureLoop::serve(PipelineStream& stream) {
  if (auto newest = stream.inbox.take()) {
    if (stream.next) links_.metrics.replaced[HandOver::kStructure].add();
    stream.next = std::move(newest);
    followSession(stream);
    if (dropUnchanged(stream)) return true;
  }
  if (!stream.next) return false;
  std::shared_ptr<FrameForms> slot;
  try {
    slot = takeSlot(stream, stream.next->frame);
  } catch (const EngineOutOfMemory& error) {
    const std::string problem = error.what();
    log(LogLevel::kWarning, "stream ", stream.name, ": a frame is refused: ", problem);
    stream.next->ticket->noteRefused(problem);
    stream.next.reset();
    return true;
  }
  if (!slot) return false;
  build(stream, *std::exchange(stream.next, std::nullopt), std::move(slot));
  return true;
}

// A publisher's camera and clock say nothing about the camera and the clock of another.
void StructureLoop::followSession(PipelineStream& stream) {
  const uint64_t session = stream.next->session;
  if (std::exchange(stream.session, session) != session) stream.track = {};
}

// The frame is compared with the resident one, not with the last: that may have been replaced or
// refused. A camera that stood since the last frame moves no more: only then is there something to
// tell. The first frame of a new session is built where the defaults are to be taken from it.
bool StructureLoop::dropUnchanged(PipelineStream& stream) const {
  const ResidentPtr resident = stream.resident();
  if (!resident || !haveSameContent(*stream.resident_frame, *stream.next->frame)) return false;
  if (stream.defaults.isBegunBy(stream.session, resident->stats)) return false;
  stream.defaults.follow(stream.session, resident->stats, resident->built_at_ns);
  links_.metrics.frames_unchanged.add();
  stream.next->ticket->noteUnchanged(resident->stats);
  const bool was_moving = stream.newest().motion.isMoving();
  stream.setMotion(stream.track.add(trackedFrame(*stream.next->frame, stream.resident_frame.get(),
                                                 resident->stats, links_.clock.nowNs())));
  stream.next.reset();
  if (was_moving) on_resident_(stream, nullptr);
  return true;
}

// Some display of the stream shows what lies between its frames.
bool StructureLoop::isInterpolated(const PipelineStream& stream) const {
  const std::vector<ActiveDisplayPtr> displays = links_.broadcaster.displays(stream.name);
  return std::any_of(displays.begin(), displays.end(), [](const ActiveDisplayPtr& display) {
    return display->spec.temporal && display->spec.temporal->mode == TemporalMode::kInterpolate;
  });
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
  const CameraMotion& motion = stream.track.add(trackedFrame(
      *offered.frame, stream.resident_frame.get(), structure->stats, structure->built_at_ns));
  // A camera that stands has seen nothing else a frame ago.
  const bool keeps_before = motion.isMoving() && motion.interval_ns > 0 && isInterpolated(stream);
  stream.setNewest({std::move(structure), motion, keeps_before ? stream.resident() : nullptr});
  stream.resident_frame = std::move(offered.frame);
  on_resident_(stream, std::move(offered.ticket));
}

// Defaults of the stream, from this frame or from an earlier one; tells where they are others now.
void StructureLoop::takeDefaults(PipelineStream& stream, const OfferedFrame& offered,
                                 ResidentStructure& structure) {
  const std::string before =
      stream.defaults.taking().count == 0 ? "" : depthRangeText(stream.defaults.stats());
  const bool are_taken =
      stream.defaults.follow(offered.session, structure.stats, structure.built_at_ns);
  const SeenSource& first = structure.sources.front();
  structure.defaults =
      streamDefaults(first.camera.intrinsics, first.size_px, stream.defaults.stats());
  structure.taking = stream.defaults.taking();
  if (!are_taken || before.empty()) return;
  const bool has_moved = structure.taking.reason == DefaultsReason::kDepthMoved;
  const std::string note =
      strCat(has_moved ? "" : "a new publisher: ", "depth was ", before, " and is ",
             depthRangeText(structure.stats),
             "; focal plane, depth range and aperture are taken anew from this frame, where a "
             "display leaves them open");
  log(LogLevel::kInfo, "stream ", stream.name, ": ", note);
  if (has_moved) offered.ticket->say(note);
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
