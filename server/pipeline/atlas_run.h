// SPDX-License-Identifier: Apache-2.0
// One atlas on its way: what is being traced, for whom, and the bands that are already packed.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "admission/memory_budget.h"
#include "base/trace_method.h"
#include "encode/encoded_band.h"
#include "engine/engine.h"
#include "pipeline/picture_cache.h"
#include "pipeline/sliced_bands.h"
#include "pipeline/video_atlas.h"
#include "publish/broadcaster.h"
#include "publish/growing_atlas.h"
#include "schedule/atlas_job.h"
#include "schedule/fair_shares.h"

namespace viewloom {

// A display of the picture, and its atlas, packed as it asked for: bands are [plane][band].
struct AtlasOutput {
  ActiveDisplayPtr display;
  GrowingAtlasPtr atlas;              // nullptr before the run's making begins
  std::unique_ptr<VideoAtlas> video;  // colour on its way into video; nullptr = no video
  uint32_t band_row_count = 0;        // divides the run's; not of video
  uint32_t bands_per_image = 0;
  uint32_t bands_per_plane = 0;

  // Bands of the planes before this one, which is the rank-th of the output.
  size_t firstBandOf(uint32_t rank) const;
};

// A plane of each strip, packed as one output asked for.
struct PackedPlane {
  size_t output = 0;  // place in AtlasRun::outputs
  AtlasPlane plane = AtlasPlane::kColor;
  uint32_t rank = 0;  // among the planes of the output
};

// Made in strips, for all displays of the picture at once.
// Thread-safety: what follows begun_ns is the picture loop's; strips are noted from any thread.
class AtlasRun {
 public:
  // `displays` share the job's picture and want its atlas, seen from `pose`.
  AtlasRun(AtlasJob atlas_job, PicturePtr resolved, const Pose& pose,
           std::vector<ActiveDisplayPtr> displays);

  bool isTracked() const { return outputs.front().display->eyes != nullptr; }
  // All displays of a picture are, or none.
  bool isChained() const { return outputs.front().display->chain != nullptr; }
  // Its display waits for the whole atlas before the next begins: that is seen by the eyes as they
  // are then, and no other display waits for more than one of them. So do displays with a rate, and
  // those of a video that has an atlas on its way: pictures that wait to be coded take memory.
  // Pictures of chained video refer to those of the atlas before.
  bool isWaitedFor() const { return isTracked() || isChained() || job.tick || is_last_of_video_; }
  // Takes the memory of its video, if it has one, before it begins. Where there is too little, it
  // takes none, and returns those of its displays that are on a second rung: they are to end, and
  // the others may have room. Throws EngineOutOfMemory where none is.
  [[nodiscard]] std::vector<ActiveDisplayPtr> reserveVideo(MemoryBudget& memory);
  // An older atlas of the picture is on its way. To be called before the making begins.
  void noteOlder();
  // All its pictures are coded.
  void releaseVideo() { video_memory_.release(); }

  // Strips are made: what all of them have seen, together.
  void noteTraced(const RayCounts& strip_counts, int64_t now_ns);
  // Nobody needs it any more: what is left of it is not made. From any thread.
  void giveUp() { is_given_up_ = true; }
  bool isGivenUp() const { return is_given_up_; }
  // Gives it up, and tells its viewers that it will not be completed.
  void abandon();
  // So many rows of a plane of a strip are packed. True for the last ones of the atlas.
  bool noteEncoded(uint32_t row_count) { return (rows_left_ -= row_count) == 0; }

  AtlasJob job;
  PicturePtr picture;       // final once its first rays are submitted
  const Pose display_pose;  // in the world
  std::vector<AtlasOutput> outputs;
  // Planes that some output wants. Colour has the form that all outputs take most directly; once
  // the atlas is being made, the form that the engine gives.
  TraceOutputs planes;
  AtlasStrips strips;
  std::vector<PackedPlane> packs;  // of each strip
  SlicedBands sliced_bands;
  TraceMethod method = TraceMethod::kWalk;
  int64_t begun_ns = 0;
  PlanPtr plan;                    // of the picture, by the loop's engine
  std::unique_ptr<Making> making;  // from when there was room until the last step
  Claim claim;                     // of the engines' time; does not change

  RayCounts counts() const;
  int64_t tracedNs() const;

 private:
  Reservation video_memory_;             // of pictures that wait, and of encoders
  bool is_last_of_video_ = false;        // does not change once the run has begun
  std::atomic<uint64_t> rows_left_ = 0;  // to be packed, of all planes
  std::atomic<bool> is_given_up_ = false;
  mutable std::mutex mutex_;
  RayCounts counts_;
  int64_t traced_ns_ = 0;  // when the last strip was seen done
};

using AtlasRunPtr = std::shared_ptr<AtlasRun>;

}  // namespace viewloom
