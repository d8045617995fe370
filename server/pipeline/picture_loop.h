// SPDX-License-Identifier: Apache-2.0
// One engine at work: atlases in fair shares, part by part.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "pipeline/atlas_run.h"
#include "pipeline/encode_pool.h"
#include "pipeline/picture_cache.h"
#include "pipeline/plan_cache.h"
#include "pipeline/structure_loop.h"
#include "pipeline/wake_up.h"
#include "schedule/begun_work.h"
#include "schedule/job_board.h"
#include "schedule/served_displays.h"

namespace viewloom {

// Parts that the loops of all engines share.
struct PictureDesk {
  JobBoard& board;
  PictureCache& pictures;
  PlanCache& plans;
  ServedDisplays& served;
  AtlasPublisher& publisher;
  EncodePool& encoders;
  FairShares& shares;
  std::function<void(FormOrder order)> prepare_form;
  // A picture's turn has come, and it has nothing new to show. True: a newer frame of the stream
  // waits and is built; then the picture is finished on the board, to begin with that.
  std::function<bool(const std::string& stream, const std::string& picture_key)> ask_newer;
  // An atlas of the job has begun.
  std::function<void(const AtlasJob& job)> on_begin;
  // Wakes the loop of an engine: there is a job for it.
  std::function<void(size_t engine)> wake;
  // Displays have come or gone: atlases that nobody watches are to be given up.
  std::atomic<bool>& has_demand_changed;
  // Whatever has begun, loops end at once: an engine has failed.
  const std::atomic<bool>& is_abandoned;
};

// One thread. What one engine waits for, a device that is busy or has kernels to compile, keeps no
// other from its work. Thread-safety: stop() from one thread, once.
class PictureLoop {
 public:
  // `engine`: rank in Engines::all.
  // `wake_up` is rung when there may be a job, or room for one.
  PictureLoop(const PipelineLinks& links, const PictureDesk& desk, size_t engine, WakeUp& wake_up);
  ~PictureLoop() { stop(); }

  // Finishes the atlases that have begun, and no others.
  void stop();
  // Forgets what will not be finished, once the loop has ended.
  void dropAll();

 private:
  void run(const std::stop_token& stop);
  // Makes the next part of the atlas that goes first. Between two parts another atlas may begin
  // that goes before all of them, if may_begin. False when there is nothing to do or no room.
  bool makePart(bool may_begin);
  bool makePartOf(const AtlasRunPtr& run);
  void dropGivenUp();
  void beginDueJobs();
  void beginOrFinish(AtlasJob& job);
  bool hasRoomForEyes(const Payers& payers) const;
  // False when no atlas comes of the job.
  bool begin(AtlasJob& job);
  void handOver(AtlasJob job, size_t engine);
  // Whether a newer frame comes for the job, which has nothing new to show; it asks for that.
  bool waitsForNewer(const AtlasJob& job, const std::vector<ActiveDisplayPtr>& all) const;
  void refuse(const std::vector<ActiveDisplayPtr>& displays, const absl::Status& status) const;
  // A structure of the job whose form for this engine is still to be prepared; nullptr = there is
  // none.
  ResidentPtr unprepared(const AtlasJob& job) const;
  // Has it prepared; then the job may begin, or its displays are refused.
  void prepareForm(AtlasJob job, ResidentPtr structure, std::vector<ActiveDisplayPtr> displays);
  void latchEyes(AtlasRun& run);
  // Stops the making of a run for which memory ran out.
  void giveUp(const AtlasRunPtr& run, const absl::Status& status);
  void refusePicture(const std::string& picture_key, const absl::Status& status);
  bool makeStep(const AtlasRunPtr& run);
  bool beginMaking(const AtlasRunPtr& run);
  void noteWork(const AtlasRun& run, const DoneWork& work) const;
  // Whether the engine makes it at once; else what it lacks is being prepared, and the picture may
  // begin when that is there.
  bool isReady(const AtlasRun& run);
  void putBack(AtlasJob job);
  void finish(const AtlasRunPtr& run);

  const PipelineLinks& links_;
  const PictureDesk& desk_;
  const size_t rank_;
  Engine& engine_;
  BegunWork<AtlasRun> begun_;  // the thread's
  WakeUp& wake_up_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace viewloom
