// SPDX-License-Identifier: Apache-2.0
#include "walk/walk_engine.h"

#include <utility>

#include "base/log.h"
#include "gpu/device_error.h"

namespace viewloom {
namespace {

class WalkedFramePreparer final : public FramePreparer {
 public:
  explicit WalkedFramePreparer(StructureWorks& works)
      : works_(works), builds_(std::make_shared<StreamBuilds>()) {}
  std::unique_ptr<PreparedFrame> make() override {
    return std::make_unique<WalkedFrame>(works_, builds_);
  }

 private:
  StructureWorks& works_;
  const std::shared_ptr<StreamBuilds> builds_;
};

}  // namespace

WalkEngine::WalkEngine(const Device& device, const WalkOptions& options)
    : works_(device),
      tracer_(device),
      strips_(device, options.strip_count_max, [this] { events_.on_room(); }),
      gatherers_(std::make_shared<GathererShelf>()),
      watch_(works_.timeline, [this](const std::exception& error) { events_.on_failure(error); }) {
  if (options.warms_up) warm_up_.emplace(works_, tracer_);
}

void WalkEngine::connect(EngineEvents events) {
  events_ = std::move(events);
}

std::unique_ptr<FramePreparer> WalkEngine::preparer() {
  return std::make_unique<WalkedFramePreparer>(works_);
}

PlanPtr WalkEngine::plan(const PicturePtr& picture, const PreparedFrame& frame) const {
  return std::make_shared<WalkPlan>(works_.device, picture, static_cast<const WalkedFrame&>(frame));
}

bool WalkEngine::workAhead() {
  if (!warm_up_) return false;
  try {
    if (warm_up_->makeNext()) return true;
    works_.device.keepKernels();
  } catch (const std::exception& error) {
    if (!isOutOfDeviceMemory(error)) throw;
    log(LogLevel::kWarning, "kernels are not compiled ahead: ", deviceErrorText(error));
  }
  warm_up_.reset();
  return false;
}

std::unique_ptr<Making> WalkEngine::begin(AtlasOrder order, HandOn hand_on) {
  order.planes.color = tracer_.colorForm(order.planes.color);
  std::shared_ptr<StripTrace> trace =
      strips_.take(WalkMaking::stripShape(order), order.is_for_eyes);
  if (!trace) return nullptr;
  const WalkTools tools{.timeline = works_.timeline,
                        .tracer = tracer_,
                        .strips = strips_,
                        .watch = watch_,
                        .gatherers = gatherers_};
  return std::make_unique<WalkMaking>(tools, std::move(order), std::move(trace),
                                      std::move(hand_on));
}

}  // namespace viewloom
