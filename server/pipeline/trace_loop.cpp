// SPDX-License-Identifier: Apache-2.0
#include "pipeline/trace_loop.h"

#include <algorithm>
#include <utility>

#include "base/log.h"
#include "base/str_cat.h"
#include "gpu/device_error.h"
#include "pipeline/job_aim.h"

namespace viewloom {
namespace {

// Of tracked displays one is swept at a time, by all threads: the eyes of those that wait behind it
// are taken when it is their turn.
constexpr size_t kSweptEyesCount = 1;

std::vector<const StructureSlot*> partsOf(const AtlasJob& job) {
  const auto& parts = job.structure->build->walked->structure.parts();
  std::vector<const StructureSlot*> all(parts.begin(), parts.end());
  if (!job.before) return all;
  const auto& before = job.before->build->walked->structure.parts();
  all.insert(all.end(), before.begin(), before.end());
  return all;
}

}  // namespace

TraceLoop::TraceLoop(const PipelineLinks& links, Timeline& timeline,
                     const StructureBuilder& builder, EncodePool& encoders,
                     AtlasPublisher& publisher, PictureCache& pictures, uint32_t slot_count,
                     const std::function<void()>& on_slot_return)
    : links_(links),
      timeline_(timeline),
      builder_(builder),
      encoders_(encoders),
      publisher_(publisher),
      pictures_(pictures),
      tracer_(links.device),
      swept_atlases_(slot_count, on_slot_return),
      swept_eyes_(kSweptEyesCount, on_slot_return) {
  for (const ColorForm color : {ColorForm::kRgba, ColorForm::kYcbcr444, ColorForm::kYcbcr420}) {
    for (const bool depth : {false, true}) {
      for (const bool mask : {false, true}) {
        rings_.push_back({{.outputs = {.color = color, .depth = depth, .mask = mask}},
                          {slot_count, on_slot_return}});
      }
    }
  }
}

bool TraceLoop::offer(AtlasJob job) {
  std::optional<AtlasJob> replaced;  // let go after the lock: its ticket may report
  std::lock_guard lock(mutex_);
  const size_t count_before = jobs_.waitingCount();
  replaced = jobs_.push(std::move(job));
  if (replaced) links_.metrics.replaced[HandOver::kTrace].add();
  const bool is_awaited =
      eyes_wait_until_ns_ && !jobs_.eyesWaitUntilNs(links_.clock.nowNs()).has_value();
  return jobs_.waitingCount() > count_before || is_awaited;
}

bool TraceLoop::offerUnlessBusy(const AtlasJob& job) {
  std::lock_guard lock(mutex_);
  if (jobs_.isBusy(job.picture_key)) return false;
  jobs_.push(job);
  return true;
}

void TraceLoop::dropAll() {
  begun_.clear();
  std::vector<AtlasJob> dropped;  // let go after the lock
  std::lock_guard lock(mutex_);
  dropped = jobs_.clear();
}

bool TraceLoop::submitPart(bool may_begin) {
  if (may_begin) beginDueJobs();
  const AtlasRunPtr run = begun_.soonest();
  if (!run) return false;
  const AtlasRunPtr other = begun_.inTurn(*run);
  if (other && submitPartOf(other)) return true;
  if (submitPartOf(run)) return true;
  // There is no slot for it: a strip that has one makes room.
  const AtlasRunPtr traced = begun_.inSlot();
  return traced && submitPartOf(traced);
}

bool TraceLoop::submitPartOf(const AtlasRunPtr& run) {
  if (!run->trace) {
    if (run->next_strip == 0) latchEyes(*run);
    if (run->method == TraceMethod::kSweep) return submitSweep(run);
    run->planes.color = tracer_.colorForm(run->direct_color);
    run->trace = takeSlot(*run);
    if (!run->trace) return false;
  }
  submit(run);
  return true;
}

std::shared_ptr<StripTrace> TraceLoop::takeSlot(const AtlasRun& run) {
  const TraceSlotShape shape = run.stripShape();
  SlotRing& ring = *std::find_if(rings_.begin(), rings_.end(), [&](const SlotRing& candidate) {
    return candidate.largest.outputs == shape.outputs;
  });
  ring.largest.include(shape);
  return ring.slots.take([&](const StripTrace& free) { return free.slot.shape().holds(shape); },
                         [&] { return std::make_unique<StripTrace>(links_.device, ring.largest); });
}

// One head at a time: who is next depends on the poses that there are when it is his turn.
bool TraceLoop::hasRoomForEyes() const {
  return !begun_.hasTracked() && swept_eyes_.hasRoom();
}

// Empty while there is no room for it, or it waits for newer poses. Under the lock.
std::optional<AtlasJob> TraceLoop::nextOfEyes() {
  if (!hasRoomForEyes()) return std::nullopt;
  const int64_t now_ns = links_.clock.nowNs();
  eyes_wait_until_ns_ = jobs_.eyesWaitUntilNs(now_ns);
  if (eyes_wait_until_ns_) return std::nullopt;
  return jobs_.beginTracked(now_ns);
}

// Begins jobs as long as one is due before everything that has begun, or all that has is long, or
// eyes wait and nobody's are served. None while eyes wait for newer poses: to begin a quilt would
// take longer.
void TraceLoop::beginDueJobs() {
  while (true) {
    std::optional<AtlasJob> job;
    {
      std::lock_guard lock(mutex_);
      eyes_wait_until_ns_.reset();
      const std::optional<int64_t> due_ns = jobs_.soonestDeadlineNs();
      const AtlasRunPtr run = begun_.soonest();
      const bool is_due = due_ns && (!run || run->isLong() || *due_ns < run->job.deadline_ns);
      const bool eyes_wait = run && !run->isTracked() && jobs_.hasTracked();
      if (!is_due && !eyes_wait) return;
      job = jobs_.isSoonestTracked() ? nextOfEyes() : jobs_.begin();
      if (!job) return;
    }
    if (!begin(*job)) {
      std::lock_guard lock(mutex_);
      jobs_.finish(job->picture_key);
    }
  }
}

bool TraceLoop::begin(AtlasJob& job) {
  const std::vector<ActiveDisplayPtr> all = links_.broadcaster.displays("");
  pictures_.keepOnly(all);
  auto [displays, eyes] = served_.take(job, all);
  if (displays.empty()) return false;
  const Aim aim = aimOf(*displays.front(), job);
  const auto picture = pictures_.get(*displays.front(), *job.structure, aim, eyes);
  if (!picture.ok()) {
    refuse(displays, picture.status());
    return false;
  }
  const auto method = prepareMethod(**picture, job);
  if (!method.ok()) {
    refuse(displays, method.status());
    return false;
  }
  for (const ActiveDisplayPtr& display : displays) {
    links_.broadcaster.noteLayout(display->id, (*picture)->layout);
  }
  auto run =
      std::make_shared<AtlasRun>(std::move(job), *picture, aim.display_pose, std::move(displays));
  run->eyes = std::move(eyes);
  run->method = *method;
  run->begun_ns = links_.clock.nowNs();
  publisher_.begin(run);
  begun_.add(std::move(run));
  return true;
}

// The eyes as they are when its first rays go, which may have waited for room. Those that cannot be
// served have a job of their own, in which they are refused.
void TraceLoop::latchEyes(AtlasRun& run) {
  if (!run.isTracked()) return;
  const ActiveDisplayPtr& display = run.outputs.front().display;
  EyePosesPtr newest = display->eyes->newest();
  if (newest != run.eyes) {
    const auto picture =
        pictures_.get(*display, *run.job.structure, aimOf(*display, run.job), newest);
    if (!picture.ok()) return;
    const auto method = prepareMethod(**picture, run.job);
    if (!method.ok()) return;
    links_.broadcaster.noteLayout(display->id, (*picture)->layout);
    run.picture = *picture;
    run.method = *method;
    served_.noteEyes(*display, newest);
    run.eyes = std::move(newest);
  }
  run.begun_ns = links_.clock.nowNs();
  std::lock_guard lock(mutex_);
  // Those that have come since have a job, or will.
  if (display->eyes->newest() == run.eyes) jobs_.forgetEyes(run.job.picture_key);
}

void TraceLoop::refuse(const std::vector<ActiveDisplayPtr>& displays, const absl::Status& status) {
  for (const ActiveDisplayPtr& display : displays) {
    links_.broadcaster.refuse(display->id, status);
  }
}

// Sweeps what can be swept; else sees to it that the structures can be walked.
absl::StatusOr<TraceMethod> TraceLoop::prepareMethod(const TraceJob& picture, const AtlasJob& job) {
  const ResidentStructure& newest = *job.structure;
  if (!job.before && newest.build->is_swept && SweepPlan::make(picture, newest.stats.inv_z_max)) {
    return TraceMethod::kSweep;
  }
  try {
    for (const ResidentPtr& structure : {job.structure, job.before}) {
      if (structure && !structure->build->is_walked) buildForWalk(*structure->build);
    }
  } catch (const std::exception& error) {
    if (!isOutOfDeviceMemory(error)) throw;
    return absl::ResourceExhaustedError(
        strCat("this display cannot be served: ", deviceErrorText(error)));
  }
  newest.stream_is_walked->store(true);
  return TraceMethod::kWalk;
}

// A structure that nobody has walked so far: the device has no newer work to do. The stream's next
// frame may be on its way into the memory that its slots share.
void TraceLoop::buildForWalk(StructureBuild& build) {
  build.prepareWalked(links_.device, makeBuildMemory(links_.device, build.shapes));
  build.walked->structure.upload(build.swept.frame());
  build.walked->structure.recordBuild(build.walked->recorder.begin(), builder_);
  timeline_.wait(build.walked->recorder.submit(timeline_));
  build.is_walked = true;
}

// The whole atlas at once: its rows lie all over it. False when every atlas is lent.
bool TraceLoop::submitSweep(const AtlasRunPtr& run) {
  SlotPool<SweptAtlas>& pool = run->isTracked() ? swept_eyes_ : swept_atlases_;
  std::shared_ptr<SweptAtlas> atlas = pool.take([](const SweptAtlas&) { return true; },
                                                [] { return std::make_unique<SweptAtlas>(); });
  if (!atlas) return false;
  auto plan = SweepPlan::make(*run->picture, run->job.structure->stats.inv_z_max);
  run->planes.color = plan->colorForm(run->direct_color);
  encoders_.push(std::make_shared<SweepRun>(run, *std::move(plan), std::move(atlas)));
  finish(run);
  return true;
}

// With the last part of a strip the slot goes on to those who pack it.
void TraceLoop::submit(const AtlasRunPtr& run) {
  StripTrace& trace = *run->trace;
  const uint32_t strip = run->next_strip;
  const BandRows rows = {run->firstRow(strip), run->rowCount(strip)};
  const BandParts parts(*run->picture, rows);
  begun_.note(*run, parts.at(run->next_part).ray_count);
  const size_t turn = run->next_part % trace.recorders.size();
  timeline_.wait(trace.submitted[turn]);
  tracer_.recordPart(trace.recorders[turn].begin(), partsOf(run->job), *run->picture, rows,
                     run->next_part, trace.slot);
  const uint64_t value = trace.recorders[turn].submit(timeline_);
  trace.submitted[turn] = value;
  if (++run->next_part < parts.count()) return;
  run->next_part = 0;
  ++run->next_strip;
  encoders_.push(TracedStrip{run, strip, std::move(run->trace), value});
  if (run->next_strip == run->stripCount()) finish(run);
}

// Everything of it has been handed on.
void TraceLoop::finish(const AtlasRunPtr& run) {
  if (!run->isWaitedFor()) {
    std::lock_guard lock(mutex_);
    jobs_.finish(run->job.picture_key);
  }
  begun_.remove(*run);
}

void TraceLoop::noteComplete(const AtlasRun& run) {
  if (!run.isWaitedFor()) return;
  std::lock_guard lock(mutex_);
  jobs_.finish(run.job.picture_key);
}

}  // namespace viewloom
