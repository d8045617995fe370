// SPDX-License-Identifier: Apache-2.0
// One engine at work: atlases by deadline, part by part.
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
#include "pipeline/wake_up.h"
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
  // Wakes the loop of an engine: there is a job for it.
  std::function<void(size_t engine)> wake;
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
  void dropAll() { begun_.clear(); }

 private:
  void run(const std::stop_token& stop);
  // Makes the next part of the atlas that is due soonest, as turns have it. Between two parts an
  // atlas with a sooner deadline, or of a tracked display, may begin, or any other if what has
  // begun is long, if may_begin. False when there is nothing to do or no room.
  bool makePart(bool may_begin);
  bool makePartOf(const AtlasRunPtr& run);
  void beginDueJobs();
  bool hasRoomForEyes() const;
  // False when no atlas comes of the job.
  bool begin(AtlasJob& job);
  void handOver(AtlasJob job, size_t engine);
  absl::Status prepare(const AtlasJob& job, const std::optional<PlannedPicture>& planned) const;
  void latchEyes(AtlasRun& run);
  // Stops the making of a run for which memory ran out.
  void giveUp(const AtlasRunPtr& run, const absl::Status& status);
  void refusePicture(const std::string& picture_key, const absl::Status& status);
  bool makeStep(const AtlasRunPtr& run);
  bool beginMaking(const AtlasRunPtr& run);
  AtlasOrder orderOf(const AtlasRun& run) const;
  // Whether the engine makes it at once; else what it lacks is being prepared, and the picture may
  // begin when that is there.
  bool isReady(const AtlasRun& run);
  void putBack(AtlasRun& run);
  void finish(const AtlasRunPtr& run);

  const PipelineLinks& links_;
  const PictureDesk& desk_;
  const size_t rank_;
  Engine& engine_;
  BegunRuns begun_;  // the thread's
  WakeUp& wake_up_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace viewloom
