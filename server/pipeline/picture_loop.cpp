// SPDX-License-Identifier: Apache-2.0
#include "pipeline/picture_loop.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "base/log.h"
#include "base/thread_name.h"
#include "pipeline/atlas_order.h"
#include "pipeline/frame_px.h"
#include "pipeline/within_memory.h"

namespace viewloom {
namespace {

const char* threadName(TraceMethod method) {
  return method == TraceMethod::kSweep ? "sweep" : "walk";
}

absl::Status cannotRender() {
  return absl::FailedPreconditionError(
      "this server cannot render such a display of this stream; choose another display");
}

}  // namespace

PictureLoop::PictureLoop(const PipelineLinks& links, const PictureDesk& desk, size_t engine,
                         WakeUp& wake_up)
    : links_(links),
      desk_(desk),
      rank_(engine),
      engine_(*links.engines.all[engine]),
      begun_(desk.shares),
      wake_up_(wake_up),
      thread_([this](const std::stop_token& stop) {
        nameThread(threadName(engine_.method()));
        try {
          run(stop);
        } catch (const std::exception& error) {
          links_.on_failure(error);
        }
      }) {}

void PictureLoop::stop() {
  thread_.request_stop();
  wake_up_.ring();
  if (thread_.joinable()) thread_.join();
}

void PictureLoop::dropAll() {
  for (const AtlasRunPtr& run : begun_.all()) run->making = nullptr;
  begun_.clear();
}

void PictureLoop::run(const std::stop_token& stop) {
  while (!desk_.is_abandoned) {
    const bool may_begin = !stop.stop_requested();
    if (makePart(may_begin)) continue;
    if (!may_begin && begun_.isEmpty()) return;
    const std::optional<int64_t> until_ns = desk_.board.eyesWaitUntilNs(rank_);
    std::optional<std::chrono::nanoseconds> pause;
    if (until_ns && may_begin) pause = links_.clock.napUntil(*until_ns);
    if (!pause && begun_.isEmpty()) pause = engine_.workAhead();
    wake_up_.wait(pause);
  }
}

bool PictureLoop::makePart(bool may_begin) {
  dropGivenUp();
  if (may_begin) beginDueJobs();
  return begun_.makeNext([this](const AtlasRunPtr& run) { return makePartOf(run); });
}

bool PictureLoop::makePartOf(const AtlasRunPtr& run) {
  bool is_made = true;
  const absl::Status status = withinMemory([&] { is_made = makeStep(run); });
  if (!status.ok()) giveUp(run, status);
  return is_made;
}

void PictureLoop::giveUp(const AtlasRunPtr& run, const absl::Status& status) {
  if (run->making) run->making->giveUp();
  finish(run);
  desk_.publisher.giveUp(*run, status);
}

void PictureLoop::refusePicture(const std::string& picture_key, const absl::Status& status) {
  log(LogLevel::kWarning, "a display is given up: ", status.message());
  for (const ActiveDisplayPtr& display : links_.broadcaster.displays("")) {
    if (display->picture_key == picture_key) links_.broadcaster.refuse(display->id, status);
  }
}

bool PictureLoop::makeStep(const AtlasRunPtr& run) {
  if (engine_.takesCores() && desk_.encoders.keepsCores(run->claim)) return false;
  if (!run->making && !beginMaking(run)) return false;
  const MakingStep step = run->making->step();
  if (!step.has_room) return false;
  if (step.predicted_ns > 0) desk_.shares.begin(run->claim, step.predicted_ns);
  if (step.is_last) finish(run);
  return true;
}

// Where an atlas is being handed out, the next look gives up: its end wakes this loop.
void PictureLoop::dropGivenUp() {
  if (desk_.has_demand_changed.exchange(false) && !desk_.publisher.giveUpUnwatched()) {
    desk_.has_demand_changed = true;
  }
  const std::vector<AtlasRunPtr> runs = begun_.all();
  for (const AtlasRunPtr& run : runs) {
    if (!run->isGivenUp()) continue;
    if (run->making) run->making->giveUp();
    finish(run);
  }
}

void PictureLoop::noteWork(const AtlasRun& run, const DoneWork& work) const {
  desk_.shares.finish(run.claim, work.predicted_ns, work.measured_ns);
  links_.metrics.observePiece(EngineWork::kTrace, run.claim.payers,
                              {.predicted_ns = work.predicted_ns, .measured_ns = work.measured_ns});
}

// False while there is no room for it.
bool PictureLoop::beginMaking(const AtlasRunPtr& run) {
  latchEyes(*run);
  AtlasOrder order = orderOf(*run, rank_);
  order.note_work = [this, run](const DoneWork& work) { noteWork(*run, work); };
  run->making = engine_.begin(std::move(order), [run, &desk = desk_](StripWorkPtr work) {
    const absl::Status status = withinMemory(
        [&] { desk.encoders.push(std::make_shared<StripBatch>(run, std::move(work))); });
    if (!status.ok()) desk.publisher.giveUp(*run, status);
  });
  if (!run->making) return false;
  run->planes = run->making->planes();
  desk_.publisher.open(*run);
  return true;
}

bool PictureLoop::hasRoomForEyes(const Payers& payers) const {
  return !begun_.hasTracked(payers) && engine_.hasRoomForEyes(nameOf(payers));
}

void PictureLoop::beginDueJobs() {
  const JobBoard::HasRoom has_room = std::bind_front(&PictureLoop::hasRoomForEyes, this);
  while (auto job = desk_.board.begin(rank_, begun_.firstClaim(), has_room)) beginOrFinish(*job);
}

void PictureLoop::beginOrFinish(AtlasJob& job) {
  const std::string picture_key = job.picture_key;
  bool has_begun = false;
  const absl::Status status = withinMemory([&] { has_begun = begin(job); });
  if (!status.ok()) refusePicture(picture_key, status);
  if (!has_begun) desk_.board.finish(picture_key);
}

bool PictureLoop::begin(AtlasJob& job) {
  const std::vector<ActiveDisplayPtr> all = links_.broadcaster.displays("");
  desk_.pictures.keepOnly(all);
  desk_.plans.keepOnly(all);
  desk_.board.keepOnly(all);
  const UnservedDisplays unserved = desk_.served.find(job);
  const std::vector<ActiveDisplayPtr>& displays = unserved.displays;
  if (displays.empty()) return waitsForNewer(job, all);
  const Aim aim = aimOf(*displays.front(), job);
  const auto picture = desk_.pictures.get(*displays.front(), *job.structure, aim, unserved.eyes);
  std::optional<PlannedPicture> planned;
  if (picture.ok()) planned = desk_.plans.get(job, *picture);
  if (planned && planned->engine != rank_) {
    handOver(std::move(job), planned->engine);
    return true;
  }
  if (!planned) {
    desk_.served.note(job, unserved);
    refuse(displays, picture.ok() ? cannotRender() : picture.status());
    return false;
  }
  if (ResidentPtr structure = unprepared(job)) {
    prepareForm(std::move(job), std::move(structure), displays);
    return true;
  }
  auto run = std::make_shared<AtlasRun>(std::move(job), *picture, aim.display_pose, displays);
  run->plan = planned->plan;
  run->method = engine_.method();
  run->begun_ns = links_.clock.nowNs();
  if (!isReady(*run)) {
    putBack(std::move(run->job));
    return true;
  }
  if (const auto ended = run->reserveVideo(links_.memory); !ended.empty()) {
    refuse(ended, absl::ResourceExhaustedError("no memory is left for a second rung"));
    putBack(std::move(run->job));
    return false;
  }
  desk_.served.note(run->job, unserved);
  for (const ActiveDisplayPtr& display : displays) {
    links_.broadcaster.noteLayout(display->id, (*picture)->layout);
  }
  begun_.add(run);
  desk_.publisher.begin(run);
  desk_.on_begin(run->job);
  return true;
}

bool PictureLoop::waitsForNewer(const AtlasJob& job,
                                const std::vector<ActiveDisplayPtr>& all) const {
  const bool is_watched =
      std::ranges::find(all, job.picture_key, &ActiveDisplay::picture_key) != all.end();
  return is_watched && asksForNewer(job) && desk_.ask_newer(job.structure->stream, job.picture_key);
}

// Frames come while kernels compile: then the picture begins with the newest.
bool PictureLoop::isReady(const AtlasRun& run) {
  return engine_.isReady(
      orderOf(run, rank_), [this, key = run.job.picture_key, stream = run.job.structure->stream,
                            asks = asksForNewer(run.job)] {
        bool comes = false;
        withinMemory([&] { comes = asks && desk_.ask_newer(stream, key); }).IgnoreError();
        if (!comes) desk_.board.finish(key);
        wake_up_.ring();
      });
}

void PictureLoop::putBack(AtlasJob job) {
  if (losesPicture(desk_.board.putBack(std::move(job), rank_))) {
    links_.metrics.replaced[HandOver::kTrace].add();
  }
}

void PictureLoop::handOver(AtlasJob job, size_t engine) {
  if (losesPicture(desk_.board.handOver(std::move(job), rank_, engine))) {
    links_.metrics.replaced[HandOver::kTrace].add();
  }
  desk_.wake(engine);
}

ResidentPtr PictureLoop::unprepared(const AtlasJob& job) const {
  for (const ResidentPtr& structure : {job.structure, job.before}) {
    if (structure && !structure->forms->isPrepared(rank_)) return structure;
  }
  return nullptr;
}

// The job has begun for the board: newer ones of its picture wait, and do not replace it for ever.
void PictureLoop::prepareForm(AtlasJob job, ResidentPtr structure,
                              std::vector<ActiveDisplayPtr> displays) {
  Claim claim = claimOf(job);
  const auto kept = std::make_shared<AtlasJob>(std::move(job));
  const uint64_t px_count = pxOf(*structure);
  desk_.prepare_form(
      {.structure = std::move(structure),
       .engine = rank_,
       .claim = std::move(claim),
       .px_count = px_count,
       .then = [this, kept, displays = std::move(displays)](const absl::Status& status) {
         if (!status.ok()) refuse(displays, status);
         desk_.board.resume(std::move(*kept), rank_);
         wake_up_.ring();
       }});
}

void PictureLoop::refuse(const std::vector<ActiveDisplayPtr>& displays,
                         const absl::Status& status) const {
  for (const auto& display : displays) links_.broadcaster.refuse(display->id, status);
}

// The eyes as they are when its first rays go, which may have waited for room. Those that cannot be
// served, or by another engine, or not yet, have a job of their own.
void PictureLoop::latchEyes(AtlasRun& run) {
  if (!run.isTracked()) return;
  const ActiveDisplayPtr& display = run.outputs.front().display;
  EyePosesPtr newest = display->eyes->newest();
  if (newest != display->eyes->used()) {
    const auto picture =
        desk_.pictures.get(*display, *run.job.structure, aimOf(*display, run.job), newest);
    if (!picture.ok()) return;
    const std::optional<PlannedPicture> planned = desk_.plans.get(run.job, *picture);
    if (!planned || planned->engine != rank_) return;
    AtlasOrder order = orderOf(run, rank_);
    order.picture = *picture;
    order.plan = planned->plan;
    if (!engine_.isReady(order, [] {})) return;
    links_.broadcaster.noteLayout(display->id, (*picture)->layout);
    run.picture = *picture;
    run.plan = planned->plan;
    display->eyes->noteUsed(std::move(newest));
  }
  run.begun_ns = links_.clock.nowNs();
  // Those that have come since have a job, or will.
  if (display->eyes->newest() == display->eyes->used()) desk_.board.forgetEyes(run.job.picture_key);
}

// Everything of it has been handed on, or will be.
void PictureLoop::finish(const AtlasRunPtr& run) {
  run->making = nullptr;
  if (!run->isWaitedFor()) desk_.board.finish(run->job.picture_key);
  begun_.remove(*run);
}

}  // namespace viewloom
