// SPDX-License-Identifier: Apache-2.0
// Walks rays through structures on a Vulkan device (shaders/README.md): any picture of any frame.
#pragma once

#include <memory>
#include <optional>

#include "engine/engine.h"
#include "trace/view_tracer.h"
#include "walk/device_watch.h"
#include "walk/strip_traces.h"
#include "walk/walk_making.h"
#include "walk/walked_frame.h"
#include "walk/warm_up.h"

namespace viewloom {

struct WalkOptions {
  uint32_t strip_count_max = 3;  // with the same planes, on their way at once
  bool warms_up = false;
};

class WalkEngine final : public Engine {
 public:
  // The device outlives it.
  WalkEngine(const Device& device, const WalkOptions& options);

  TraceMethod method() const override { return TraceMethod::kWalk; }
  void connect(EngineEvents events) override;
  bool takes(const Frame&) const override { return true; }
  std::unique_ptr<FramePreparer> preparer() override;
  PlanPtr plan(const PicturePtr& picture, const PreparedFrame& frame) const override;
  bool hasRoomForEyes() const override { return true; }
  std::unique_ptr<Making> begin(AtlasOrder order, HandOn hand_on) override;
  bool workAhead() override;
  void drain() override { watch_.drain(); }

 private:
  StructureWorks works_;
  ViewTracer tracer_;
  std::optional<WarmUp> warm_up_;
  EngineEvents events_;
  StripTraces strips_;
  const std::shared_ptr<GathererShelf> gatherers_;
  DeviceWatch watch_;  // last: what it tells uses all of the above
};

}  // namespace viewloom
