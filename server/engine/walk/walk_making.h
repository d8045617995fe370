// SPDX-License-Identifier: Apache-2.0
// One atlas that is walked: part by part, each of bounded work.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "engine/engine.h"
#include "lens/band_gatherer.h"
#include "trace/view_tracer.h"
#include "walk/device_use.h"
#include "walk/device_watch.h"
#include "walk/part_costs.h"
#include "walk/part_meter.h"
#include "walk/strip_traces.h"
#include "walk/walked_frame.h"

namespace viewloom {

// How long rays of a picture take, and those of all pictures. Thread-safety: as CostEstimate.
struct WalkCosts {
  PartCosts on_device;
  CostEstimate on_host;  // a gathered ray of a lens
  std::shared_ptr<WalkCosts> of_all = nullptr;

  void note(RayKind kind, uint64_t ray_count, int64_t measured_ns);
  void noteHost(uint64_t ray_count, int64_t measured_ns);
};

// The picture as it is traced. Where the CPU gathers its lens, that is a picture of its own: the
// device then traces the middle rays alone.
struct WalkPlan final : Plan {
  // `costs`: what is known of other pictures; they learn from this one.
  WalkPlan(const Device& device, const PicturePtr& whole, const WalkedFrame& frame,
           std::shared_ptr<WalkCosts> costs);
  bool holdsFor(const PreparedFrame& frame) const override;

  const Device& device;
  const bool is_in_reach;  // of the CPU: the structure of such frames
  const PicturePtr picture;
  const std::shared_ptr<WalkCosts> costs;  // of this picture
};

// Gatherers that threads take for a piece. Thread-safety: all methods may be called from any
// thread.
class GathererShelf {
 public:
  std::unique_ptr<BandGatherer> take();
  void putBack(std::unique_ptr<BandGatherer> gatherer);

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<BandGatherer>> free_;
};

// Tools that atlases are walked with. All of them outlive the atlases.
struct WalkTools {
  Timeline& timeline;
  ViewTracer& tracer;
  StripTraces& strips;
  DeviceWatch& watch;
  PartMeter& meter;
  DeviceUse& use;
  std::shared_ptr<GathererShelf> gatherers;
};

class WalkMaking final : public Making {
 public:
  // `trace`: for the first strip.
  WalkMaking(WalkTools tools, AtlasOrder order, std::shared_ptr<StripTrace> trace, HandOn hand_on);

  const TraceOutputs& planes() const override { return order_.planes; }
  bool holdsRoom() const override { return trace_ != nullptr; }
  // Waits until the device has no more than this part to do. Throws EngineOutOfMemory.
  MakingStep step() override;
  void giveUp() override;

  // Kernels that the strips of such an atlas need and nobody has compiled.
  static MissingKernels missingKernels(ViewTracer& tracer, const AtlasOrder& order);
  // Shape of the slots that the strips of such an atlas take.
  static TraceSlotShape stripShape(const AtlasOrder& order);

 private:
  MakingStep makePart();
  void forgetMeans();
  MakingStep stepMeans();
  MakingStep stepPart();
  CommandRecorder& nextRecorder();
  // Rays on their way, and what was known before they were recorded.
  struct Rays {
    RayKind kind;
    CostEstimate cost;
    uint64_t kernel_count;  // of the device
  };
  Rays raysOf(RayKind kind) const { return {kind, costs_->on_device[kind], device_.kernelCount()}; }
  // Returns the prediction.
  int64_t submit(CommandRecorder& recorder, const Rays& rays, uint64_t ray_count);
  RayKind kindOf(PartKind kind) const;
  void handOn(uint64_t timeline_value);

  const WalkTools tools_;
  const LastingUse use_;
  const AtlasOrder order_;
  const PicturePtr picture_;  // as it is traced
  const Device& device_;
  const std::shared_ptr<WalkCosts> costs_;
  const HandOn hand_on_;
  const std::vector<const StructureSlot*> structures_;
  uint32_t strip_ = 0;                 // the next part is of it
  std::optional<BandParts> parts_;     // that are left of the strip; empty before its first
  uint32_t turn_ = 0;                  // of the recorders
  uint64_t last_value_ = 0;            // timeline's, of the last submission
  bool has_means_ = false;             // all that it takes are made
  std::shared_ptr<StripTrace> trace_;  // with the parts of the strip before that
};

}  // namespace viewloom
