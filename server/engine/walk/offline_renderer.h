// SPDX-License-Identifier: Apache-2.0
// Builds one frame and traces displays of it, one after the other, with the server's own engine.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/worker_pool.h"
#include "display/atlas_layout.h"
#include "gpu/gpu_timer.h"
#include "gpu/submission.h"
#include "lens/band_gatherer.h"
#include "structure/frame_structure.h"
#include "trace/view_tracer.h"

namespace viewloom {

// A whole atlas in host memory. Planes that were not asked for are empty. Top row first.
struct RenderedAtlas {
  std::shared_ptr<const AtlasLayout> layout;
  std::vector<uint32_t> color;   // uint32_t[height][width]: R, G, B, 255 in memory order
  std::vector<float> linear;     // float[height][width][4]: sRGB-encoded, before rounding to 8 bits
  std::vector<uint8_t> mask;     // uint8_t[height][width], RayClass
  std::vector<uint32_t> visits;  // uint32_t[height][width]: nodes and facets each ray looked at
  Coverage coverage;
  ReflectionCounts reflections;
};

// Where a lens's second stage is gathered (shaders/lens.md).
enum class GatheringPlace : uint8_t {
  kHost,   // by the CPU, where that can be
  kDevice  // by the device alone
};

// The device must outlive it. Throws vk::SystemError when the device fails or has no room.
// Thread-safety: none; one thread at a time.
class OfflineRenderer {
 public:
  explicit OfflineRenderer(const Device& device,
                           GatheringPlace gathering_place = GatheringPlace::kHost);

  // Makes this frame the one that is rendered from here on, for displays that stand where the
  // camera of its first source does; or did at another time, if that is given: then they keep the
  // focal plane of what was built before.
  void build(const Frame& frame, const std::optional<Pose>& camera_pose = {});
  // Needs a frame. Refuses atlases beyond AtlasLimits. `on_progress` hears how many of the atlas's
  // rows are done.
  absl::StatusOr<RenderedAtlas> render(
      const DisplaySpec& spec, const TraceOutputs& outputs,
      const std::function<void(uint32_t done_rows, uint32_t row_count)>& on_progress);

  // Statistics of each source.
  std::vector<SourceStats> stats() const;

 private:
  void traceBand(const TraceJob& job, BandRows rows, TraceSlot& slot);
  void gatherLens(const TraceJob& job, BandRows rows, TraceSlot& slot);

  const Device& device_;
  const GatheringPlace gathering_place_;
  Timeline timeline_;
  CommandRecorder recorder_;
  StructureBuilder builder_;
  ViewTracer tracer_;
  WorkerPool workers_;
  std::vector<BandGatherer> gatherers_;  // one a worker
  std::optional<FrameStructure> structure_;
  std::vector<SeenSource> sources_;
  Camera shown_camera_;
  std::optional<SourceStats> focal_stats_;  // of what was built before
};

}  // namespace viewloom
