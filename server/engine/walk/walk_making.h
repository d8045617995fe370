// SPDX-License-Identifier: Apache-2.0
// One atlas that is walked: part by part, at most two of them ahead of the device.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "engine/engine.h"
#include "lens/band_gatherer.h"
#include "trace/view_tracer.h"
#include "walk/device_watch.h"
#include "walk/strip_traces.h"
#include "walk/walked_frame.h"

namespace viewloom {

// The picture as it is traced. Where the CPU gathers its lens, that is a picture of its own: the
// device then traces the middle rays alone.
struct WalkPlan final : Plan {
  WalkPlan(const Device& device, const PicturePtr& whole, const WalkedFrame& frame);
  bool holdsFor(const PreparedFrame& frame) const override;

  const Device& device;
  const bool is_in_reach;  // of the CPU: the structure of such frames
  const PicturePtr picture;
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
  std::shared_ptr<GathererShelf> gatherers;
};

class WalkMaking final : public Making {
 public:
  // `trace`: for the first strip.
  WalkMaking(WalkTools tools, AtlasOrder order, std::shared_ptr<StripTrace> trace, HandOn hand_on);

  const TraceOutputs& planes() const override { return order_.planes; }
  bool holdsRoom() const override { return trace_ != nullptr; }
  // Waits until the device is no more than two parts behind. Throws EngineOutOfMemory.
  MakingStep step() override;

  // Kernels that the strips of such an atlas need and nobody has compiled.
  static MissingKernels missingKernels(ViewTracer& tracer, const AtlasOrder& order);
  // Shape of the slots that the strips of such an atlas take.
  static TraceSlotShape stripShape(const AtlasOrder& order);

 private:
  MakingStep makePart();
  void handOn(uint64_t timeline_value);

  const WalkTools tools_;
  const AtlasOrder order_;
  const PicturePtr picture_;  // as it is traced
  const HandOn hand_on_;
  const std::vector<const StructureSlot*> structures_;
  uint32_t strip_ = 0;  // the next part is of it
  uint32_t part_ = 0;
  std::shared_ptr<StripTrace> trace_;  // with the parts of the strip before that
};

}  // namespace viewloom
