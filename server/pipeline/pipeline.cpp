// SPDX-License-Identifier: Apache-2.0
#include "pipeline/pipeline.h"

#include <atomic>
#include <chrono>
#include <deque>
#include <utility>

#include "base/log.h"
#include "display/atlas_layout.h"
#include "pipeline/encode_pool.h"
#include "pipeline/frame_builder.h"
#include "pipeline/frame_entrance.h"
#include "pipeline/grace.h"
#include "pipeline/picture_loop.h"
#include "pipeline/retime_loop.h"
#include "pipeline/stream_retimer.h"
#include "pipeline/stream_table.h"
#include "pipeline/structure_loop.h"
#include "pipeline/tick_loop.h"
#include "pipeline/within_memory.h"

namespace viewloom {
namespace {

using OnFailure = std::function<void(const std::exception&)>;

// For what has begun when the pipeline drains; the service manager waits longer.
constexpr std::chrono::seconds kGrace{4};

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
        engine_wake_ups(links.engines.all.size()),
        publisher(links, [this](const AtlasRun& run) { noteComplete(run); }),
        encoders(links, publisher, shares,
                 {.thread_count = options.encode_thread_count,
                  .video_thread_count = options.video_thread_count,
                  .video_encoders = options.video_encoders,
                  .on_cores_free = [this] { ringEngines(); }}),
        board(links.clock, shares, links.engines.all.size()),
        pictures(options.atlas_limits),
        plans(links.engines),
        served(links.broadcaster),
        desk{board,
             pictures,
             plans,
             served,
             publisher,
             encoders,
             shares,
             [this](FormOrder order) { structures.prepareForm(std::move(order)); },
             [this](const std::string& stream, const std::string& picture_key) {
               return entrance.askNewer(stream, picture_key);
             },
             [this](const AtlasJob& job) { entrance.noteBegun(job); },
             [this](size_t engine) { engine_wake_ups[engine].ring(); },
             has_demand_changed,
             has_failed},
        streams(links.engines, links.memory, options.structure_slots_per_stream,
                [this] { structure_bell.ring(); }),
        entrance(
            streams, links.broadcaster, links.clock,
            {.offer = [this](AtlasJob job) { offer(std::move(job)); },
             .finish = [this](const std::string& picture_key) { board.finish(picture_key); },
             .on_finished = [this] { ringEngines(); },
             .ring_builds = [this] { structure_bell.ring(); },
             .takes_unasked =
                 [this](const PipelineStream& stream) { return structures.takesUnasked(stream); }}),
        frames(links),
        retimes(links.metrics, std::bind_front(&Loops::retime, this)),
        ticks(links, [this](const AtlasJob& job,
                            const ActiveDisplayPtr& display) { return offerTick(job, display); }),
        structures({links, streams, frames, board, shares, structure_bell},
                   {.on_resident = [this](const PipelineStream& stream,
                                          const FrameTicketPtr& ticket) { serve(stream, ticket); },
                    .on_served = [this](PipelineStream& stream) { entrance.goOn(stream); },
                    .let_in = [this](PipelineStream& stream) { entrance.letIn(stream); }}) {
    for (size_t engine = 0; engine < links.engines.all.size(); ++engine) {
      links.engines.all[engine]->connect(
          {.on_room = [this, engine] { engine_wake_ups[engine].ring(); },
           .on_failure = links.on_failure});
      loops.push_back(std::make_unique<PictureLoop>(links, desk, engine, engine_wake_ups[engine]));
    }
  }

  // A job for each picture of the stream; of those that tick, at their next tick. The ticket is of
  // the resident structure's frame, if that has not been reported.
  void serve(const PipelineStream& stream, const FrameTicketPtr& ticket);
  void offerFrame(const FrameOrigin& origin, FramePtr frame, const FrameTicketPtr& ticket);
  // Offers a tick; false while the picture's last atlas is on its way.
  bool offerTick(const AtlasJob& job, const ActiveDisplayPtr& display);
  bool offerTrace(AtlasJob job, const DisplaySpec& spec);
  // Makes what the tick shows, unless there is no room, and has it traced.
  void retime(AtlasJob job, const DisplaySpec& spec, const std::stop_token& stop);
  // Wakes those whom it concerns. False: there was nothing new.
  bool offer(AtlasJob job);
  void noteComplete(const AtlasRun& run);
  void ringEngines();
  void fail(const std::exception& error);

  const OnFailure on_failure;
  const PipelineLinks links;
  ChangeBell structure_bell;
  std::deque<WakeUp> engine_wake_ups;
  std::atomic<bool> is_draining = false;
  std::atomic<bool> has_failed = false;
  std::atomic<bool> has_demand_changed = false;
  FairShares shares;
  AtlasPublisher publisher;
  EncodePool encoders;
  JobBoard board;
  PictureCache pictures;
  PlanCache plans;
  ServedDisplays served;
  const PictureDesk desk;
  std::vector<std::unique_ptr<PictureLoop>> loops;  // one an engine
  StreamTable streams;
  FrameEntrance entrance;
  const FrameBuilder frames;
  RetimeLoop retimes;  // gives back to the next
  TickLoop ticks;
  StructureLoop structures;
};

void Pipeline::Loops::fail(const std::exception& error) {
  if (has_failed.exchange(true)) return;  // what follows from the first failure
  ringEngines();                          // they see it and end
  on_failure(error);
}

void Pipeline::Loops::offerFrame(const FrameOrigin& origin, FramePtr frame,
                                 const FrameTicketPtr& ticket) {
  if (is_draining) return ticket->noteRefused("the server is shutting down");
  const PipelineStreamPtr stream = streams.open(origin.stream);
  stream->notePublisher(origin.publisher);
  const auto replaced = stream->inbox.push({std::move(frame), origin.session, ticket});
  if (replaced) links.metrics.replaced[HandOver::kStructure].add();
  entrance.noteOffered(stream);
}

bool Pipeline::Loops::offer(AtlasJob job) {
  const JobBoard::Offered offered = board.offer(std::move(job));
  if (losesPicture(offered.replaced)) links.metrics.replaced[HandOver::kTrace].add();
  if (offered.is_news) engine_wake_ups[offered.engine].ring();
  return offered.is_news;
}

// The next of its picture may begin, whichever engine makes it.
void Pipeline::Loops::noteComplete(const AtlasRun& run) {
  if (run.isWaitedFor()) board.finish(run.job.picture_key);
  ringEngines();
}

void Pipeline::Loops::ringEngines() {
  for (WakeUp& wake_up : engine_wake_ups) wake_up.ring();
}

void Pipeline::Loops::serve(const PipelineStream& stream, const FrameTicketPtr& ticket) {
  const StreamInstant newest = stream.newest();
  const ResidentPtr& resident = newest.structure;
  if (!resident) return;
  const std::vector<ActiveDisplayPtr> displays = links.broadcaster.displays(stream.name);
  if (ticket) ticket->noteBuilt(resident->stats, !displays.empty());
  for (AtlasJob& job : jobsOfFrame(resident, displays, ticket, links.clock.nowNs())) {
    offer(std::move(job));
  }
  ticks.offer(stream.name, newest, ticket);
}

bool Pipeline::Loops::offerTick(const AtlasJob& job, const ActiveDisplayPtr& display) {
  if (isRetimed(job)) return !board.isBusy(job.picture_key) && retimes.offer(job, display);
  // Before the board is asked: what was retimed goes there next.
  return !retimes.isBusy(job) && offerTrace(job, display->spec);
}

void Pipeline::Loops::retime(AtlasJob job, const DisplaySpec& spec, const std::stop_token& stop) {
  try {
    bool is_offered = false;
    const absl::Status status = withinMemory(
        [&] { is_offered = showAsOfTick(job, shares, stop) && offerTrace(job, spec); });
    if (!status.ok()) log(LogLevel::kWarning, "a tick is left out: ", status.message());
    if (!is_offered) ticks.giveBack(std::move(job));
  } catch (const std::exception& error) {
    links.on_failure(error);
  }
}

bool Pipeline::Loops::offerTrace(AtlasJob job, const DisplaySpec& spec) {
  job.asked_ns = links.clock.nowNs();
  job.deadline_ns = deadlineNs(spec, job.asked_ns);
  const std::optional<JobBoard::Offered> offered = board.offerUnlessBusy(job);
  if (offered) engine_wake_ups[offered->engine].ring();
  return offered.has_value();
}

Pipeline::Pipeline(PipelineLinks links, const PipelineOptions& options)
    : loops_(std::make_unique<Loops>(std::move(links), options)) {}

Pipeline::~Pipeline() {
  drain();
  for (const auto& engine : loops_->links.engines.all) {
    engine->connect({.on_room = [] {}, .on_failure = [](const std::exception&) {}});
  }
}

void Pipeline::offerFrame(const FrameOrigin& origin, FramePtr frame, ReportFrame report) {
  const uint64_t number = frame->format.number;
  FrameTicketPtr ticket;
  const absl::Status status = withinMemory([&] {
    ticket = std::make_shared<FrameTicket>(number, std::move(report));
    loops_->offerFrame(origin, std::move(frame), ticket);
  });
  if (status.ok()) return;
  loops_->entrance.noteLost(origin.stream);
  const std::string reason(status.message());
  if (ticket) return ticket->noteRefused(reason);
  report({.number = number, .outcome = FrameOutcome::kRefused, .reason = reason});
}

uint64_t Pipeline::preparedBytes(const FrameFormat& format) const {
  return loops_->links.engines.preparedBytes(format);
}

FairShares& Pipeline::shares() {
  return loops_->shares;
}

bool Pipeline::wantsFrame(const std::string& stream) {
  return loops_->entrance.wantsFrame(stream);
}

void Pipeline::onWanted(std::function<void(const std::string&)> then) {
  loops_->entrance.onWanted(std::move(then));
}

void Pipeline::noteLost(const std::string& stream) {
  loops_->entrance.noteLost(stream);
}

void Pipeline::forgetStream(const std::string& stream) {
  loops_->entrance.forget(stream);
}

void Pipeline::serveDisplays(const std::string& stream_name) {
  loops_->has_demand_changed = true;
  loops_->ringEngines();
  loops_->structure_bell.ring();
  if (const PipelineStreamPtr stream = loops_->streams.find(stream_name)) {
    loops_->serve(*stream, nullptr);
  }
}

void Pipeline::serveEyes(uint64_t display_id) {
  const ActiveDisplayPtr display = loops_->links.broadcaster.display(display_id);
  if (!display || display->spec.temporal) return;  // seen by the newest eyes at its next tick
  const PipelineStreamPtr stream = loops_->streams.find(display->stream);
  if (!stream) return;
  const ResidentPtr resident = stream->resident();
  if (!resident) return;
  // Only what is new wakes a loop: thousands of poses a second would each take a core from those
  // who answer them.
  loops_->offer(jobForEyes(*display, resident, loops_->links.clock.nowNs()));
}

// Work that has begun is finished if that does not take long.
void Pipeline::drain() {
  if (loops_->is_draining.exchange(true)) return;
  loops_->entrance.stop();
  const Grace grace(kGrace, [this] {
    loops_->publisher.giveUpAll();
    loops_->ringEngines();
  });
  loops_->structures.stop();
  loops_->ticks.stop();
  loops_->retimes.stop();
  for (const auto& loop : loops_->loops) loop->stop();
  for (const auto& engine : loops_->links.engines.all) engine->drain();
  loops_->encoders.stop();
  for (const auto& loop : loops_->loops) loop->dropAll();
  loops_->board.clear();
  loops_->publisher.dropAll();
  loops_->streams.clear();
}

}  // namespace viewloom
