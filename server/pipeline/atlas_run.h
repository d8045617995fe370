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
#include "pipeline/job_queue.h"
#include "pipeline/picture_cache.h"
#include "pipeline/resident_structure.h"
#include "pipeline/strip_trace.h"
#include "publish/broadcaster.h"
#include "trace/trace_slot.h"

namespace viewloom {

// A display of the picture, and the bands packed as it asked for.
struct AtlasOutput {
  ActiveDisplayPtr display;
  std::vector<EncodedBand> bands;  // [plane][band], every one written once, by one thread
  uint32_t band_row_count = 0;     // divides the run's
  uint32_t bands_per_image = 0;
  uint32_t bands_per_plane = 0;
};

// Rays that an atlas is walked by before others go first: a large quilt's.
inline constexpr uint64_t kTurnRays = uint64_t{1} << 24;

// Traced in strips of strip_row_count rows, each of one image, all displays of the picture at once.
// Thread-safety: what follows next_strip is the trace loop's; strips are noted from any thread.
class AtlasRun {
 public:
  // `displays` share the job's picture and want its atlas, seen from `pose`.
  AtlasRun(AtlasJob atlas_job, PicturePtr resolved, const Pose& pose,
           std::vector<ActiveDisplayPtr> displays);

  bool isTracked() const { return outputs.front().display->eyes != nullptr; }
  // Its display waits for the whole atlas before the next begins: that is seen by the eyes as they
  // are then, and no other display waits for more than one of them. So do displays with a rate.
  bool isWaitedFor() const { return isTracked() || job.tick; }

  uint32_t stripCount() const;
  uint32_t imageOf(uint32_t strip) const { return strip / stripsPerImage(); }
  // In its image, and in the atlas.
  uint32_t rowInImage(uint32_t strip) const { return strip % stripsPerImage() * strip_row_count; }
  uint32_t firstRow(uint32_t strip) const;
  uint32_t rowCount(uint32_t strip) const;
  TraceSlotShape stripShape() const;
  // It has had more of the device than most atlases need: others go first, or take turns with it.
  bool isLong() const { return !isTracked() && submitted_rays >= kTurnRays; }

  void noteTraced(const Coverage& strip_coverage, int64_t now_ns,
                  const ReflectionCounts& strip_reflections = {});
  // True for the last strip of the atlas.
  bool noteEncoded() { return --strips_left_ == 0; }

  AtlasJob job;
  PicturePtr picture;       // final once its first rays are submitted
  const Pose display_pose;  // in the world
  EyePosesPtr eyes;         // that it is seen by, of a tracked display
  std::vector<AtlasOutput> outputs;
  ColorForm direct_color;  // as all outputs take it most directly, or kRgba
  TraceOutputs planes;     // that some output wants; colour is settled once its rays are submitted
  TraceMethod method = TraceMethod::kWalk;
  uint32_t strip_row_count = 0;
  int64_t begun_ns = 0;
  uint32_t next_strip = 0;
  // Of a walk: the next part of that strip, and the slot that the parts before it are in.
  uint32_t next_part = 0;
  std::shared_ptr<StripTrace> trace;
  uint64_t submitted_rays = 0;

  Coverage coverage() const;
  ReflectionCounts reflections() const;
  int64_t tracedNs() const;

 private:
  uint32_t stripsPerImage() const;

  std::atomic<uint32_t> strips_left_;
  mutable std::mutex mutex_;
  Coverage coverage_;
  ReflectionCounts reflections_;
  int64_t traced_ns_ = 0;  // when the last strip was seen done
};

using AtlasRunPtr = std::shared_ptr<AtlasRun>;

}  // namespace viewloom
