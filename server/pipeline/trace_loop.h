// SPDX-License-Identifier: Apache-2.0
// What is traced when: jobs by deadline, strip by strip, at most as far ahead as there are slots.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/begun_runs.h"
#include "pipeline/encode_pool.h"
#include "pipeline/job_queue.h"
#include "pipeline/picture_cache.h"
#include "pipeline/served_displays.h"
#include "pipeline/slot_pool.h"
#include "pipeline/strip_trace.h"
#include "structure/structure_builder.h"
#include "trace/view_tracer.h"

namespace viewloom {

// Slots are kept apart by the planes they trace: without and with depth, without and with mask, and
// by the form of their colour.
inline constexpr uint32_t kSlotRingCount = 12;

// Thread-safety: offer(), isBusy() and noteComplete() from any thread; the rest is the GPU loop's,
// and after its end anyone's.
class TraceLoop {
 public:
  TraceLoop(const PipelineLinks& links, Timeline& timeline, const StructureBuilder& builder,
            EncodePool& encoders, AtlasPublisher& publisher, PictureCache& pictures,
            uint32_t slot_count, const std::function<void()>& on_slot_return);

  // Replaces a job of the same picture and an older structure that has not begun. True: none of the
  // picture has waited so far, or eyes have waited for these poses. Else nothing new can begin:
  // what one waits for wakes the loop.
  bool offer(AtlasJob job);
  // An atlas of the picture waits or is on its way.
  bool isBusy(const std::string& picture_key) {
    std::lock_guard lock(mutex_);
    return jobs_.isBusy(picture_key);
  }
  // Of a tick: false while an atlas of its picture is on its way.
  bool offerUnlessBusy(const AtlasJob& job);
  // The run's atlas is published: the next of its picture may begin. From any thread.
  void noteComplete(const AtlasRun& run);
  // Forgets the jobs that have not begun and, after a failure, those that will not be finished.
  void dropAll();

  // Records and submits the next part of a strip of the atlas that is due soonest, as turns have
  // it. Between two parts an atlas with a sooner deadline, or of a tracked display, may begin, or
  // any other if what has begun is long, if may_begin. Waits until the device is no more than two
  // parts of a strip behind. False when there is nothing to do or no free slot.
  bool submitPart(bool may_begin);
  bool hasBegun() const { return !begun_.isEmpty(); }
  // When nothing was submitted: from when on something may be, whatever happens until then.
  std::optional<int64_t> waitsUntilNs() {
    std::lock_guard lock(mutex_);
    return eyes_wait_until_ns_;
  }

 private:
  // The slots that trace the same planes. They grow to the largest strip that was asked for.
  struct SlotRing {
    TraceSlotShape largest;
    SlotPool<StripTrace> slots;
  };

  std::shared_ptr<StripTrace> takeSlot(const AtlasRun& run);
  void beginDueJobs();
  bool hasRoomForEyes() const;
  std::optional<AtlasJob> nextOfEyes();
  bool begin(AtlasJob& job);
  bool submitPartOf(const AtlasRunPtr& run);
  void latchEyes(AtlasRun& run);
  bool submitSweep(const AtlasRunPtr& run);
  void submit(const AtlasRunPtr& run);
  absl::StatusOr<TraceMethod> prepareMethod(const TraceJob& picture, const AtlasJob& job);
  void buildForWalk(StructureBuild& build);
  void refuse(const std::vector<ActiveDisplayPtr>& displays, const absl::Status& status);
  void finish(const AtlasRunPtr& run);

  const PipelineLinks& links_;
  Timeline& timeline_;
  const StructureBuilder& builder_;
  EncodePool& encoders_;
  AtlasPublisher& publisher_;
  PictureCache& pictures_;
  ViewTracer tracer_;
  std::vector<SlotRing> rings_;  // one for each set of planes, see ringOf
  SlotPool<SweptAtlas> swept_atlases_;
  SlotPool<SweptAtlas> swept_eyes_;  // of tracked displays: no quilt's end is waited for
  BegunRuns begun_;
  ServedDisplays served_;

  std::mutex mutex_;
  JobQueue jobs_;                              // guarded by mutex_
  std::optional<int64_t> eyes_wait_until_ns_;  // guarded by mutex_
};

}  // namespace viewloom
