// SPDX-License-Identifier: Apache-2.0
#include "pipeline/pipeline.h"

#include <atomic>
#include <set>
#include <string_view>
#include <utility>

#include "display/rgbd.h"
#include "pipeline/encode_pool.h"
#include "pipeline/frame_builder.h"
#include "pipeline/gpu_loop.h"
#include "pipeline/retime_loop.h"
#include "pipeline/stream_retimer.h"
#include "pipeline/stream_table.h"
#include "pipeline/structure_loop.h"
#include "pipeline/tick_loop.h"
#include "pipeline/trace_loop.h"
#include "pipeline/turns.h"

namespace viewloom {
namespace {

// An atlas is due after the time that its rays should take, so that a small one overtakes a large
// one.
constexpr int64_t kDueNsPerRay = 10;

int64_t rayCount(const QuiltSpec& quilt) {
  return int64_t(quilt.size_px.area());
}
int64_t rayCount(const StereoSpec& stereo) {
  return 2 * int64_t(stereo.eye_size_px.area());
}
int64_t rayCount(const CamerasSpec& cameras) {
  const size_t count = cameras.grid ? cameras.grid->count() : cameras.cameras.size();
  return int64_t(count * cameras.tile_size_px.area());
}
int64_t rayCount(const LenticularSpec& lenticular) {
  return 3 * int64_t(lenticular.calibration->screen_px.area());
}
int64_t rayCount(const IntegralSpec& integral) {
  return int64_t(integral.panel_px.area());
}
int64_t rayCount(const RgbdSpec& rgbd) {
  const TileGrid grid = tileGrid(rgbd);
  return int64_t(grid.width_px * grid.height_px);
}
int64_t rayCount(const DisplaySpec& spec) {
  const int64_t px_count = std::visit([](const auto& kind) { return rayCount(kind); }, spec.kind);
  const uint32_t of_lens = spec.lens ? spec.lens->walked_count : 1;
  return px_count * std::max(spec.filter.sample_count, of_lens);
}

using OnFailure = std::function<void(const std::exception&)>;

PipelineLinks withFailure(PipelineLinks links, OnFailure on_failure) {
  links.on_failure = std::move(on_failure);
  return links;
}

}  // namespace

// Members in the order of data flow: each loop is destroyed before what it hands on to.
struct Pipeline::Loops {
  Loops(PipelineLinks given_links, const PipelineOptions& options)
      : on_failure(std::move(given_links.on_failure)),
        links(withFailure(std::move(given_links),
                          [this](const std::exception& error) { fail(error); })),
        timeline(links.device),
        builder(links.device),
        publisher(links,
                  [this](const AtlasRun& run) {
                    traces.noteComplete(run);
                    gpu_wake_up.ring();
                  }),
        encoders(links, timeline, publisher, options.encode_thread_count,
                 kSlotRingCount * options.trace_slot_count),
        pictures(options.atlas_limits),
        traces(links, timeline, builder, encoders, publisher, pictures, options.trace_slot_count,
               [this] { gpu_wake_up.ring(); }),
        streams(options.structure_slots_per_stream, [this] { structure_wake_up.ring(); }),
        gpu(links, timeline, builder, traces, gpu_wake_up),
        frames(links, gpu),
        retimes(links.metrics,
                [this](AtlasJob job, const DisplaySpec& spec) { retime(std::move(job), spec); }),
        ticks(links, [this](const AtlasJob& job,
                            const ActiveDisplayPtr& display) { return offerTick(job, display); }),
        structures(links, streams, frames, structure_wake_up,
                   [this](const PipelineStream& stream, const FrameTicketPtr& ticket) {
                     serve(stream, ticket);
                   }) {}

  // A job for each picture of the stream; of those that tick, at their next tick. The ticket is of
  // the resident structure's frame, if that has not been reported.
  void serve(const PipelineStream& stream, const FrameTicketPtr& ticket);
  // Of a tick: false while the picture's last atlas is on its way.
  bool offerTick(const AtlasJob& job, const ActiveDisplayPtr& display);
  bool offerTrace(AtlasJob job, const DisplaySpec& spec);
  // Makes what the tick shows, unless there is no room, and has it traced.
  void retime(AtlasJob job, const DisplaySpec& spec);
  // Of an atlas that is wanted from now on.
  int64_t deadlineNs(const DisplaySpec& spec) const;
  void fail(const std::exception& error);

  const OnFailure on_failure;
  const PipelineLinks links;
  WakeUp structure_wake_up;
  WakeUp gpu_wake_up;
  std::atomic<bool> is_draining = false;
  std::atomic<bool> has_failed = false;
  Timeline timeline;
  StructureBuilder builder;
  AtlasPublisher publisher;
  EncodePool encoders;
  PictureCache pictures;
  TraceLoop traces;
  StreamTable streams;
  GpuLoop gpu;
  FrameBuilder frames;
  RetimeLoop retimes;  // gives back to the next
  TickLoop ticks;
  StructureLoop structures;
};

void Pipeline::Loops::fail(const std::exception& error) {
  if (has_failed.exchange(true)) return;  // what follows from the first failure
  gpu.abandon();
  on_failure(error);
}

void Pipeline::Loops::serve(const PipelineStream& stream, const FrameTicketPtr& ticket) {
  const StreamInstant newest = stream.newest();
  const ResidentPtr& resident = newest.structure;
  if (!resident) return;
  const std::vector<ActiveDisplayPtr> displays = links.broadcaster.displays(stream.name);
  if (ticket) ticket->noteBuilt(resident->stats, !displays.empty());
  std::set<std::string_view> offered;
  for (const ActiveDisplayPtr& display : displays) {
    if (display->spec.temporal || !offered.insert(display->picture_key).second) continue;
    traces.offer({.picture_key = display->picture_key,
                  .structure = resident,
                  .deadline_ns = deadlineNs(display->spec),
                  .ticket = ticket,
                  .is_tracked = isTracked(display->spec),
                  .poses = display->eyes ? display->eyes->times() : PoseTimes{},
                  .asked_ns = links.clock.nowNs()});
  }
  ticks.offer(stream.name, newest, ticket);
  gpu_wake_up.ring();
}

bool Pipeline::Loops::offerTick(const AtlasJob& job, const ActiveDisplayPtr& display) {
  if (isRetimed(job)) return !traces.isBusy(job.picture_key) && retimes.offer(job, display);
  // Before the trace loop is asked: what was retimed goes there next.
  return !retimes.isBusy(job) && offerTrace(job, display->spec);
}

void Pipeline::Loops::retime(AtlasJob job, const DisplaySpec& spec) {
  try {
    if (!showAsOfTick(job) || !offerTrace(job, spec)) ticks.giveBack(std::move(job));
  } catch (const std::exception& error) {
    links.on_failure(error);
  }
}

bool Pipeline::Loops::offerTrace(AtlasJob job, const DisplaySpec& spec) {
  job.deadline_ns = deadlineNs(spec);
  job.asked_ns = links.clock.nowNs();
  const bool is_taken = traces.offerUnlessBusy(job);
  if (is_taken) gpu_wake_up.ring();
  return is_taken;
}

int64_t Pipeline::Loops::deadlineNs(const DisplaySpec& spec) const {
  const int64_t due_ns = links.clock.nowNs() + kDueNsPerRay * rayCount(spec);
  return isTracked(spec) ? due_ns - kEyesAhead_ns : due_ns;
}

Pipeline::Pipeline(PipelineLinks links, const PipelineOptions& options)
    : loops_(std::make_unique<Loops>(std::move(links), options)) {}

Pipeline::~Pipeline() {
  drain();
}

void Pipeline::offerFrame(const FrameOrigin& origin, FramePtr frame, ReportFrame report) {
  const uint64_t number = frame->format.number;
  auto ticket = std::make_shared<FrameTicket>(number, std::move(report));
  if (loops_->is_draining) {
    ticket->noteRefused("the server is shutting down");
    return;
  }
  const auto replaced = loops_->streams.open(origin.stream)
                            ->inbox.push({std::move(frame), origin.session, std::move(ticket)});
  if (replaced) loops_->links.metrics.replaced[HandOver::kStructure].add();
  loops_->structure_wake_up.ring();
}

void Pipeline::forgetStream(const std::string& stream) {
  loops_->streams.forget(stream);
}

void Pipeline::serveDisplays(const std::string& stream_name) {
  if (const PipelineStreamPtr stream = loops_->streams.find(stream_name)) {
    loops_->serve(*stream, nullptr);
  }
}

void Pipeline::serveEyes(const ActiveDisplay& display) {
  if (display.spec.temporal) return;  // seen by the newest eyes at its next tick
  const PipelineStreamPtr stream = loops_->streams.find(display.stream);
  if (!stream) return;
  const ResidentPtr resident = stream->resident();
  if (!resident) return;
  const bool is_new = loops_->traces.offer({.picture_key = display.picture_key,
                                            .structure = resident,
                                            .deadline_ns = loops_->deadlineNs(display.spec),
                                            .is_for_eyes = true,
                                            .is_tracked = true,
                                            .poses = display.eyes->times(),
                                            .asked_ns = loops_->links.clock.nowNs()});
  // Thousands of poses a second would each take a core from those who answer them.
  if (is_new) loops_->gpu_wake_up.ring();
}

void Pipeline::drain() {
  if (loops_->is_draining.exchange(true)) return;
  loops_->structures.stop();
  loops_->ticks.stop();
  loops_->retimes.stop();
  loops_->gpu.stop();
  loops_->encoders.stop();
  loops_->traces.dropAll();
  loops_->publisher.dropAll();
  loops_->streams.clear();
}

}  // namespace viewloom
