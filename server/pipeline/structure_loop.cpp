// SPDX-License-Identifier: Apache-2.0
#include "pipeline/structure_loop.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/log.h"
#include "base/str_cat.h"
#include "base/thread_name.h"
#include "pipeline/build_charge.h"
#include "pipeline/frame_px.h"
#include "pipeline/stream_retimer.h"
#include "pipeline/within_memory.h"

namespace viewloom {
StructureLoop::StructureLoop(const Links& links, Events events)
    : links_(links), events_(std::move(events)), queue_(links.shares) {
  for (const BuildLane lane : {BuildLane::kAny, BuildLane::kShort}) {
    threads_.emplace_back([this, lane](const std::stop_token& stop) {
      nameThread("build");
      try {
        run(lane, stop);
      } catch (const std::exception& error) {
        links_.pipeline.on_failure(error);
      }
    });
  }
}

bool StructureLoop::takesUnasked(const PipelineStream& stream) {
  std::lock_guard lock(mutex_);
  return !stream.turn.waitUntilNs(demandOf(stream), links_.pipeline.clock.nowNs());
}

void StructureLoop::prepareForm(FormOrder order) {
  {
    std::lock_guard lock(mutex_);
    queue_.push(std::move(order));
  }
  links_.bell.ring();
}

void StructureLoop::stop() {
  for (std::jthread& thread : threads_) thread.request_stop();
  for (std::jthread& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
}

void StructureLoop::run(BuildLane lane, const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const BuildQueue::Look look{
        .lane = lane, .change_count = links_.bell.count(), .now_ns = links_.pipeline.clock.nowNs()};
    Work work;
    const absl::Status status = withinMemory([&] { work = take(look); });
    if (!status.ok()) log(LogLevel::kWarning, "no memory is left to look for frames");
    for (const PipelineStreamPtr& stream : work.let_in) events_.let_in(*stream);
    if (work.stream) {
      serve(work.stream, look, stop);
    } else if (work.form) {
      serve(*work.form, stop);
    } else {
      std::optional<std::chrono::nanoseconds> time;
      if (work.until_ns) time = links_.pipeline.clock.napUntil(*work.until_ns);
      links_.bell.waitForChange(look.change_count, stop, time);
    }
  }
}

StructureLoop::Work StructureLoop::take(const BuildQueue::Look& look) {
  std::lock_guard lock(mutex_);
  const std::vector<PipelineStreamPtr> streams = links_.streams.all();
  std::vector<BuildQueue::StreamBuild> builds;
  for (const PipelineStreamPtr& stream : streams) {
    builds.push_back({.turn = &stream->turn,
                      .has_frame = [&stream] { return stream->hasFrame(); },
                      .has_waiting = [&stream] { return stream->door.hasWaiting(); },
                      .demand = [this, &stream] { return demandOf(*stream); },
                      .claim = [&stream] { return stream->claim(); }});
  }
  BuildQueue::Next next = queue_.take(look, builds);
  Work work{.stream = next.stream ? streams[*next.stream] : nullptr,
            .form = std::move(next.form),
            .until_ns = next.until_ns};
  for (const size_t place : next.let_in) work.let_in.push_back(streams[place]);
  return work;
}

StreamDemand StructureLoop::demandOf(const PipelineStream& stream) const {
  const std::vector<ActiveDisplayPtr> displays = links_.pipeline.broadcaster.displays(stream.name);
  const auto takesAll = [this](const ActiveDisplayPtr& display) {
    const bool has_eyes = isTracked(display->spec);
    return display->spec.temporal || (has_eyes && !links_.board.isWaiting(display->picture_key));
  };
  return {.is_watched = !displays.empty(), .takes_all = std::ranges::any_of(displays, takesAll)};
}

void StructureLoop::serve(const FormOrder& form, const std::stop_token& stop) {
  make(form, stop);
  {
    std::lock_guard lock(mutex_);
    queue_.finish(form);
  }
  links_.bell.ring();
}

void StructureLoop::serve(const PipelineStreamPtr& stream, const BuildQueue::Look& look,
                          const std::stop_token& stop) {
  const BuildOutcome outcome = buildNext(stream, look.lane, stop);
  // Else the frame is still to be built.
  if (outcome == BuildOutcome::kServed || outcome == BuildOutcome::kNothing) stream->door.close();
  if (outcome != BuildOutcome::kTooLong) events_.on_served(*stream);
  {
    std::lock_guard lock(mutex_);
    stream->turn.giveBack(outcome, look.change_count);
  }
  if (outcome != BuildOutcome::kNoSlot) links_.bell.ring();
}

BuildOutcome StructureLoop::buildNext(const PipelineStreamPtr& taken, BuildLane lane,
                                      const std::stop_token& stop) {
  PipelineStream& stream = *taken;
  if (auto newest = stream.inbox.take()) {
    const auto replaced = stream.frames.offer(*std::move(newest));
    if (replaced) links_.pipeline.metrics.replaced[HandOver::kStructure].add();
    bool is_unchanged = false;  // where there is no memory to know it, the frame is built
    const absl::Status status = withinMemory([&] { is_unchanged = dropUnchanged(stream); });
    if (!status.ok()) log(LogLevel::kWarning, "stream ", stream.name, ": ", status.message());
    if (is_unchanged) return BuildOutcome::kServed;
  }
  const OfferedFrame* const next = stream.frames.next();
  if (next == nullptr) return BuildOutcome::kNothing;
  if (!takes(lane, stream.px_cost.predictNs(pxOf(*next->frame)))) return BuildOutcome::kTooLong;
  if (!isReadyFor(*next->frame, taken)) return BuildOutcome::kNotReady;
  std::shared_ptr<FrameForms> slot;
  const absl::Status has_slot = withinMemory([&] { slot = takeSlot(stream, next->frame); });
  if (has_slot.ok() && !slot) return BuildOutcome::kNoSlot;
  OfferedFrame offered = stream.frames.takeNext();
  const FrameTicketPtr ticket = offered.ticket;
  const absl::Status status =
      has_slot.ok()
          ? withinMemory([&] { build(stream, std::move(offered), std::move(slot), stop); })
          : has_slot;
  if (status.ok()) return BuildOutcome::kServed;
  log(LogLevel::kWarning, "stream ", stream.name, ": a frame is refused: ", status.message());
  ticket->noteRefused(std::string(status.message()));
  return BuildOutcome::kServed;
}

bool StructureLoop::isReadyFor(const Frame& frame, const PipelineStreamPtr& stream) {
  {
    std::lock_guard lock(mutex_);
    stream->turn.awaitReady();  // before the engine may call back
  }
  const auto note_ready = [this, stream] {
    std::lock_guard lock(mutex_);
    stream->turn.noteReady();
  };
  bool is_ready = true;  // where there is no memory to ask: then the build says so
  const absl::Status status = withinMemory([&] {
    is_ready = links_.builder.isReadyFor(frame, [this, note_ready] {
      note_ready();
      links_.bell.ring();
    });
  });
  if (is_ready) note_ready();
  if (!status.ok()) log(LogLevel::kWarning, "stream ", stream->name, ": ", status.message());
  return is_ready;
}

void StructureLoop::make(const FormOrder& order, const std::stop_token& stop) {
  BuildCharge charge(links_.shares, links_.pipeline.metrics, order.claim, queue_.predictNs(order));
  absl::Status status;
  try {
    status = withinMemory([&] {
      order.structure->forms->prepare(order.engine, links_.pipeline.clock,
                                      charge.events([&] { return stop.stop_requested(); }));
    });
  } catch (const PreparationGivenUp&) {
    return;
  }
  if (!status.ok()) {
    status =
        absl::ResourceExhaustedError(strCat("this display cannot be rendered: ", status.message()));
  }
  queue_.noteMade(order, charge.settle());
  order.then(status);
}

// A camera that stood since the last frame moves no more: only then is there something to tell.
bool StructureLoop::dropUnchanged(PipelineStream& stream) const {
  const ResidentPtr resident = stream.resident();
  if (!resident) return false;
  const auto motion = stream.frames.followUnchanged(*resident, links_.pipeline.clock.nowNs());
  if (!motion) return false;
  links_.pipeline.metrics.frames_unchanged.add();
  stream.turn.noteBuilt(demandOf(stream), links_.pipeline.clock.nowNs());
  const bool was_moving = stream.newest().motion.isMoving();
  stream.setMotion(*motion);
  stream.frames.takeNext().ticket->noteUnchanged(resident->stats);
  if (was_moving) events_.on_resident(stream, nullptr);
  return true;
}

bool StructureLoop::isInterpolated(const PipelineStream& stream) const {
  return showBetweenFrames(links_.pipeline.broadcaster.displays(stream.name));
}

std::shared_ptr<FrameForms> StructureLoop::takeSlot(PipelineStream& stream,
                                                    const FramePtr& frame) const {
  stream.slots.setCountMax(stream.slot_count + (isInterpolated(stream) ? 1 : 0));
  return links_.builder.takeSlot(stream.slots, stream.preparers, frame);
}

void StructureLoop::build(PipelineStream& stream, OfferedFrame offered,
                          std::shared_ptr<FrameForms> slot, const std::stop_token& stop) {
  const uint64_t px_count = pxOf(*offered.frame);
  BuildCharge charge(links_.shares, links_.pipeline.metrics, stream.claim(),
                     stream.px_cost.predictNs(px_count));
  auto structure = std::make_shared<ResidentStructure>(describe(*offered.frame));
  structure->stream = stream.name;
  structure->serial = ++last_serial_;
  try {
    links_.builder.build(*offered.frame, std::move(slot),
                         charge.events([&] { return stop.stop_requested(); }), *structure);
  } catch (const PreparationGivenUp& error) {
    offered.ticket->noteRefused(error.what());
    return;
  }
  stream.px_cost.note(px_count, charge.settle());
  stream.turn.noteBuilt(demandOf(stream), links_.pipeline.clock.nowNs());
  takeDefaults(stream, offered, *structure);
  if (movesByItself(*offered.frame)) {
    if (!stream.retimer)
      stream.retimer = std::make_shared<StreamRetimer>(links_.pipeline, links_.builder);
    structure->moving_frame = offered.frame;
    structure->retimer = stream.retimer;
  }

  count(*structure, *offered.frame);
  stream.setNewest(stream.frames.becomeResident(std::move(offered.frame), std::move(structure),
                                                stream.resident(), isInterpolated(stream)));
  events_.on_resident(stream, std::move(offered.ticket));
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
  const PipelineLinks& links = links_.pipeline;
  const FrameTimes& times = structure.times;
  links.metrics.structures_built.add();
  links.metrics.observeStage(Stage::kReceive, times.last_chunk_ns - times.first_chunk_ns);
  links.metrics.observeStage(Stage::kDecode, times.decoded_ns - times.last_chunk_ns);
  links.metrics.observeStage(Stage::kUpload, structure.upload_ns);
  links.metrics.observeStage(Stage::kBuild, structure.build_ns);
  links.directory.noteResident(structure.stream, structure.frame_number,
                               structure.defaults.source_size_px,
                               uint32_t(frame.sources.front().size()), structure.stats);
}

}  // namespace viewloom
