// SPDX-License-Identifier: Apache-2.0
#include "pipeline/structure_loop.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/log.h"
#include "base/str_cat.h"
#include "base/thread_name.h"
#include "base/thread_time.h"
#include "pipeline/frame_px.h"
#include "pipeline/stream_retimer.h"
#include "pipeline/within_memory.h"

namespace viewloom {
namespace {

// Builds up to this long are made by the thread that makes no longer ones.
constexpr int64_t kShortBuild_ns = 50'000'000;
// Time of a px of a form until something was measured.
constexpr double kFormPxStart_ns = 30;

}  // namespace

StructureLoop::StructureLoop(const Links& links, OnResident on_resident, OnServed on_served)
    : links_(links),
      on_resident_(std::move(on_resident)),
      on_served_(std::move(on_served)),
      form_px_cost_(kFormPxStart_ns) {
  for (const Lane lane : {Lane::kAny, Lane::kShort}) {
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

void StructureLoop::prepareForm(FormOrder order) {
  {
    std::lock_guard lock(mutex_);
    forms_.push_back(std::move(order));
  }
  links_.bell.ring();
}

void StructureLoop::stop() {
  for (std::jthread& thread : threads_) thread.request_stop();
  for (std::jthread& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
}

void StructureLoop::run(Lane lane, const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    Look look{.lane = lane, .change_count = links_.bell.count(), .until_ns = std::nullopt};
    std::optional<Work> work;
    const absl::Status status = withinMemory([&] { work = take(look); });
    if (!status.ok()) log(LogLevel::kWarning, "no memory is left to look for frames");
    if (work) {
      serve(*std::move(work), look, stop);
      continue;
    }
    std::optional<std::chrono::nanoseconds> time;
    if (look.until_ns) time = links_.pipeline.clock.napUntil(*look.until_ns);
    links_.bell.waitForChange(look.change_count, stop, time);
  }
}

std::optional<StructureLoop::Work> StructureLoop::take(Look& look) {
  std::lock_guard lock(mutex_);
  std::vector<Work> works;
  addStreams(look, works);
  for (const FormOrder& form : forms_) {
    if (form_in_hand_.contains(form.structure.get())) continue;
    const bool is_long = form_px_cost_.predictNs(pxOf(*form.structure)) > kShortBuild_ns;
    if (look.lane == Lane::kShort && is_long) continue;
    works.push_back({.claim = form.claim, .stream = nullptr, .form = form});
  }
  const Work* const next = links_.shares.next(works, [](const Work& work) { return &work.claim; });
  if (next == nullptr) return std::nullopt;
  if (next->stream) {
    next->stream->is_in_hand = true;
  } else {
    form_in_hand_.insert(next->form.structure.get());
    const auto isTaken = [&](const FormOrder& form) {
      return form.structure == next->form.structure && form.engine == next->form.engine &&
             form.claim.display == next->form.claim.display;
    };
    forms_.erase(std::ranges::find_if(forms_, isTaken));
  }
  return *next;
}

// Those that have a frame that may be built now.
void StructureLoop::addStreams(Look& look, std::vector<Work>& works) {
  const int64_t now_ns = links_.pipeline.clock.nowNs();
  for (const PipelineStreamPtr& stream : links_.streams.all()) {
    if (stream->is_in_hand || stream->served_in_vain == look.change_count) continue;
    if (stream->inbox.empty() && stream->frames.next() == nullptr) continue;
    if (look.lane == Lane::kShort && stream->takes_long) continue;
    if (const auto until_ns = stream->gate.waitUntilNs(demandOf(*stream), now_ns)) {
      look.until_ns = std::min(look.until_ns.value_or(*until_ns), *until_ns);
      continue;
    }
    works.push_back({.claim = stream->claim(), .stream = stream, .form = {}});
  }
}

StreamDemand StructureLoop::demandOf(const PipelineStream& stream) const {
  const std::vector<ActiveDisplayPtr> displays = links_.pipeline.broadcaster.displays(stream.name);
  const auto waits = [this](const ActiveDisplayPtr& display) {
    return !display->spec.temporal && links_.board.isWaiting(display->picture_key);
  };
  return {.is_watched = !displays.empty(),
          .all_wait = std::ranges::all_of(displays, waits),
          .is_asked = stream.is_asked};
}

void StructureLoop::serve(Work work, const Look& look, const std::stop_token& stop) {
  if (!work.stream) {
    serveForm(work.form, stop);
    {
      std::lock_guard lock(mutex_);
      form_in_hand_.erase(work.form.structure.get());
    }
    links_.bell.ring();
    return;
  }
  PipelineStream& stream = *work.stream;
  const Outcome outcome = serveStream(stream, look.lane, stop);
  if (outcome != Outcome::kTooLong) {
    stream.is_asked = false;
    on_served_(stream.name);
  }
  {
    std::lock_guard lock(mutex_);
    stream.is_in_hand = false;
    stream.takes_long = outcome == Outcome::kTooLong;
    stream.served_in_vain.reset();
    if (outcome == Outcome::kNoSlot) stream.served_in_vain = look.change_count;
  }
  if (outcome != Outcome::kNoSlot) links_.bell.ring();
}

StructureLoop::Outcome StructureLoop::serveStream(PipelineStream& stream, Lane lane,
                                                  const std::stop_token& stop) {
  if (auto newest = stream.inbox.take()) {
    const auto replaced = stream.frames.offer(*std::move(newest));
    if (replaced) links_.pipeline.metrics.replaced[HandOver::kStructure].add();
    if (dropUnchanged(stream)) return Outcome::kServed;
  }
  const OfferedFrame* const next = stream.frames.next();
  if (next == nullptr) return Outcome::kNothing;
  if (lane == Lane::kShort && stream.px_cost.predictNs(pxOf(*next->frame)) > kShortBuild_ns) {
    return Outcome::kTooLong;
  }
  std::shared_ptr<FrameForms> slot;
  const absl::Status has_slot = withinMemory([&] { slot = takeSlot(stream, next->frame); });
  if (has_slot.ok() && !slot) return Outcome::kNoSlot;
  OfferedFrame offered = stream.frames.takeNext();
  const FrameTicketPtr ticket = offered.ticket;
  const absl::Status status =
      has_slot.ok()
          ? withinMemory([&] { build(stream, std::move(offered), std::move(slot), stop); })
          : has_slot;
  if (status.ok()) return Outcome::kServed;
  log(LogLevel::kWarning, "stream ", stream.name, ": a frame is refused: ", status.message());
  ticket->noteRefused(std::string(status.message()));
  return Outcome::kServed;
}

PreparationEvents StructureLoop::eventsFor(const Claim& claim, const std::stop_token& stop) const {
  return {.on_piece =
              [this, payers = claim.payers](const DoneWork& work) {
                links_.pipeline.metrics.observePiece(
                    EngineWork::kBuild, payers,
                    {.predicted_ns = work.predicted_ns, .measured_ns = work.measured_ns});
              },
          .is_given_up = [stop] { return stop.stop_requested(); }};
}

void StructureLoop::serveForm(const FormOrder& order, const std::stop_token& stop) {
  const uint64_t px_count = pxOf(*order.structure);
  const int64_t predicted_ns = form_px_cost_.predictNs(px_count);
  links_.shares.begin(order.claim, predicted_ns);
  const int64_t begun_ns = wallTimeNs();
  absl::Status status;
  try {
    status = withinMemory([&] {
      order.structure->forms->prepare(order.engine, links_.pipeline.clock,
                                      eventsFor(order.claim, stop));
    });
  } catch (const PreparationGivenUp&) {
    return;
  }
  if (!status.ok()) {
    status =
        absl::ResourceExhaustedError(strCat("this display cannot be rendered: ", status.message()));
  }
  const int64_t measured_ns = wallTimeNs() - begun_ns;
  form_px_cost_.note(px_count, measured_ns);
  links_.shares.finish(order.claim, predicted_ns, measured_ns);
  order.then(status);
}

// A camera that stood since the last frame moves no more: only then is there something to tell.
bool StructureLoop::dropUnchanged(PipelineStream& stream) const {
  const ResidentPtr resident = stream.resident();
  if (!resident) return false;
  const auto motion = stream.frames.followUnchanged(*resident, links_.pipeline.clock.nowNs());
  if (!motion) return false;
  links_.pipeline.metrics.frames_unchanged.add();
  const bool was_moving = stream.newest().motion.isMoving();
  stream.setMotion(*motion);
  stream.frames.takeNext().ticket->noteUnchanged(resident->stats);
  if (was_moving) on_resident_(stream, nullptr);
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
  const Claim claim = stream.claim();
  const uint64_t px_count = pxOf(*offered.frame);
  const int64_t predicted_ns = stream.px_cost.predictNs(px_count);
  links_.shares.begin(claim, predicted_ns);
  const int64_t begun_ns = wallTimeNs();
  auto structure = std::make_shared<ResidentStructure>(describe(*offered.frame));
  structure->stream = stream.name;
  structure->serial = ++last_serial_;
  try {
    links_.builder.build(*offered.frame, std::move(slot), eventsFor(claim, stop), *structure);
  } catch (const PreparationGivenUp& error) {
    offered.ticket->noteRefused(error.what());
    return;
  } catch (...) {
    links_.shares.finish(claim, predicted_ns, wallTimeNs() - begun_ns);
    throw;
  }
  const int64_t measured_ns = wallTimeNs() - begun_ns;
  stream.px_cost.note(px_count, measured_ns);
  links_.shares.finish(claim, predicted_ns, measured_ns);
  stream.gate.noteBuilt(demandOf(stream), links_.pipeline.clock.nowNs());
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
