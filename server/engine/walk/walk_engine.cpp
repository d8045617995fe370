// SPDX-License-Identifier: Apache-2.0
#include "walk/walk_engine.h"

#include <utility>

#include "base/log.h"
#include "base/thread_name.h"
#include "base/thread_time.h"
#include "gpu/device_error.h"
#include "walk/within_device_memory.h"

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

// Until something was measured: as slow as a software device is with one core, or slower than any
// hardware.
WalkCosts startCosts(const Device& device) {
  constexpr double kSoftwareRay_ns = 2000;
  constexpr double kHardwareRay_ns = 5;
  // Answers, px and texels take some arithmetic each, and no walk.
  constexpr double kSoftwareOther_ns = 30;
  constexpr double kHardwareOther_ns = 1;
  constexpr double kGatheredRay_ns = 20;
  const bool is_software = device.info().is_software;
  return {.on_device = PartCosts(is_software ? kSoftwareRay_ns : kHardwareRay_ns,
                                 is_software ? kSoftwareOther_ns : kHardwareOther_ns),
          .on_host = CostEstimate(kGatheredRay_ns)};
}

// A picture needs one to three kernels that others do not have.
constexpr uint32_t kCompileThreads = 2;

}  // namespace

CompilePlace compilePlaceFor(const Device& device) {
  return device.info().is_software ? CompilePlace::kRecordingThread : CompilePlace::kOwnThreads;
}

WalkEngine::WalkEngine(const Device& device, const WalkOptions& options)
    : works_(device, options.memory),
      tracer_(device),
      strips_(device, options.memory, options.strip_count_max, [this] { events_.on_room(); }),
      gatherers_(std::make_shared<GathererShelf>()),
      costs_(std::make_shared<WalkCosts>(startCosts(device))),
      meter_(works_.timeline, watch_, works_.clock),
      watch_(works_.timeline, [this](const std::exception& error) { events_.on_failure(error); }) {
  if (options.warms_up) warm_up_.emplace(works_, tracer_);
  if (options.compile_place == CompilePlace::kRecordingThread) return;
  compiler_.emplace(
      kCompileThreads, [this](const std::exception& error) { events_.on_failure(error); },
      options.before_each_kernel);
}

void WalkEngine::connect(EngineEvents events) {
  events_ = std::move(events);
  if (!compiler_ || !warm_up_ || warmer_.joinable()) return;
  for (MissingKernels& kernels : works_.builder.likelyKernels()) {
    compiler_->compileAhead(std::move(kernels));
  }
  startWarmer();
}

void WalkEngine::startWarmer() {
  warmer_ = std::jthread([this](const std::stop_token& stop) {
    nameThread("warm up");
    try {
      while (!stop.stop_requested() && warmNext(stop)) {
      }
    } catch (const std::exception& error) {
      events_.on_failure(error);
    }
  });
}

std::unique_ptr<FramePreparer> WalkEngine::preparer() {
  return std::make_unique<WalkedFramePreparer>(works_);
}

bool WalkEngine::isReadyFor(const Frame& frame, std::function<void()> then) {
  if (!compiler_) return true;
  MissingKernels missing;
  works_.builder.addMissing(frame, missing);
  if (missing.empty()) return true;
  compiler_->compile(std::move(missing), std::move(then));
  return false;
}

// Its picture comes next, once the frame is prepared.
PlanPtr WalkEngine::plan(const PicturePtr& picture, const PreparedFrame& frame) const {
  works_.use.note(wallTimeNs());
  return std::make_shared<WalkPlan>(works_.device, picture, static_cast<const WalkedFrame&>(frame),
                                    costs_);
}

bool WalkEngine::isReady(const AtlasOrder& order, std::function<void()> then) {
  if (!compiler_) return true;
  MissingKernels missing = WalkMaking::missingKernels(tracer_, order);
  if (missing.empty()) return true;
  compiler_->compile(std::move(missing), std::move(then));
  return false;
}

bool WalkEngine::warmNext(const std::stop_token& stop) {
  try {
    if (warm_up_->makeNext(stop)) return true;
    works_.device.keepKernels();
  } catch (const std::exception& error) {
    if (!isOutOfDeviceMemory(error)) throw;
    log(LogLevel::kWarning, "kernels are not compiled ahead: ", deviceErrorText(error));
  }
  warm_up_.reset();
  return false;
}

// A software device compiles on its queue: whoever came in the middle of that would wait for it.
std::optional<std::chrono::nanoseconds> WalkEngine::workAhead() {
  if (compiler_ || !warm_up_) return std::nullopt;
  const std::chrono::nanoseconds rest(works_.use.restNs(wallTimeNs()));
  if (rest > rest.zero()) return rest;
  if (!warmNext({})) return std::nullopt;
  return rest;
}

void WalkEngine::drain() {
  warmer_.request_stop();
  if (compiler_) compiler_->drain();
  if (warmer_.joinable()) warmer_.join();
  warm_up_.reset();
  watch_.drain();
}

std::unique_ptr<Making> WalkEngine::begin(AtlasOrder order, HandOn hand_on) {
  order.planes.color = tracer_.colorForm(order.planes.color);
  std::shared_ptr<StripTrace> trace =
      withinDeviceMemory([&] { return strips_.take(WalkMaking::stripShape(order), order); });
  if (!trace) return nullptr;
  const WalkTools tools{.timeline = works_.timeline,
                        .tracer = tracer_,
                        .strips = strips_,
                        .watch = watch_,
                        .meter = meter_,
                        .use = works_.use,
                        .gatherers = gatherers_};
  return std::make_unique<WalkMaking>(tools, std::move(order), std::move(trace),
                                      std::move(hand_on));
}

}  // namespace viewloom
