// SPDX-License-Identifier: Apache-2.0
// One atlas on its way: what is being traced, for whom, and the bands that are already packed.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/trace_method.h"
#include "encode/encoded_band.h"
#include "engine/engine.h"
#include "pipeline/job_queue.h"
#include "pipeline/picture_cache.h"
#include "pipeline/resident_structure.h"
#include "publish/broadcaster.h"
#include "publish/growing_atlas.h"

namespace viewloom {

// A display of the picture, and its atlas, packed as it asked for: bands are [plane][band].
struct AtlasOutput {
  ActiveDisplayPtr display;
  GrowingAtlasPtr atlas;        // nullptr before the run's making begins
  uint32_t band_row_count = 0;  // divides the run's
  uint32_t bands_per_image = 0;
  uint32_t bands_per_plane = 0;
};

// Rays that an atlas is walked by before others go first: a large quilt's.
inline constexpr uint64_t kTurnRays = uint64_t{1} << 24;
// Time of worker threads that an atlas takes before others go first: that of most atlases.
inline constexpr int64_t kTurn_ns = 50'000'000;

// Made in strips, for all displays of the picture at once.
// Thread-safety: what follows begun_ns is the picture loop's; strips are noted from any thread.
class AtlasRun {
 public:
  // `displays` share the job's picture and want its atlas, seen from `pose`.
  AtlasRun(AtlasJob atlas_job, PicturePtr resolved, const Pose& pose,
           std::vector<ActiveDisplayPtr> displays);

  bool isTracked() const { return outputs.front().display->eyes != nullptr; }
  // Its display waits for the whole atlas before the next begins: that is seen by the eyes as they
  // are then, and no other display waits for more than one of them. So do displays with a rate.
  bool isWaitedFor() const { return isTracked() || job.tick; }

  // It has had more of the device than most atlases need: others go first, or take turns with it.
  bool isLong() const { return !isTracked() && submitted_rays >= kTurnRays; }
  // The same of the worker threads.
  bool isLongWork() const { return !isTracked() && worked_ns >= kTurn_ns; }

  // Strips are made: what all of them have seen, together.
  void noteTraced(const RayCounts& strip_counts, int64_t now_ns);
  // It will not be completed.
  void abandon() const;
  // True for the last strip of the atlas.
  bool noteEncoded() { return --strips_left_ == 0; }

  AtlasJob job;
  PicturePtr picture;       // final once its first rays are submitted
  const Pose display_pose;  // in the world
  std::vector<AtlasOutput> outputs;
  // Planes that some output wants. Colour has the form that all outputs take most directly; once
  // the atlas is being made, the form that the engine gives.
  TraceOutputs planes;
  AtlasStrips strips;
  TraceMethod method = TraceMethod::kWalk;
  int64_t begun_ns = 0;
  PlanPtr plan;                    // of the picture, by the loop's engine
  std::unique_ptr<Making> making;  // from when there was room until the last step
  uint64_t submitted_rays = 0;
  int64_t worked_ns = 0;  // by worker threads, EncodeQueue's

  RayCounts counts() const;
  int64_t tracedNs() const;

 private:
  std::atomic<uint32_t> strips_left_;
  mutable std::mutex mutex_;
  RayCounts counts_;
  int64_t traced_ns_ = 0;  // when the last strip was seen done
};

using AtlasRunPtr = std::shared_ptr<AtlasRun>;

}  // namespace viewloom
