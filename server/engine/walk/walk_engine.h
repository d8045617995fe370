// SPDX-License-Identifier: Apache-2.0
// Walks rays through structures on a Vulkan device (shaders/walk.md): any picture of any frame.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "engine/engine.h"
#include "trace/view_tracer.h"
#include "walk/device_watch.h"
#include "walk/kernel_compiler.h"
#include "walk/strip_traces.h"
#include "walk/walk_making.h"
#include "walk/walked_frame.h"
#include "walk/warm_up.h"

namespace viewloom {

// Where kernels are compiled.
enum class CompilePlace : uint8_t {
  // By the thread that records them. Software devices compile a kernel when they come to its first
  // dispatch, so no other thread could do it beforehand.
  kRecordingThread,
  // By threads of their own: a frame or a picture whose kernels are missing waits for them, and no
  // other.
  kOwnThreads
};

// On hardware by own threads.
CompilePlace compilePlaceFor(const Device& device);

struct WalkOptions {
  uint32_t strip_count_max = 3;  // with the same planes, on their way at once
  bool warms_up = false;
  MemoryBudget& memory = unboundedMemory();  // of frames and strips; outlives the engine
  CompilePlace compile_place = CompilePlace::kRecordingThread;
  std::function<void()> before_each_kernel = [] {};  // for tests: own threads call it
};

class WalkEngine final : public Engine {
 public:
  // The device outlives it.
  WalkEngine(const Device& device, const WalkOptions& options);

  TraceMethod method() const override { return TraceMethod::kWalk; }
  bool takesCores() const override { return works_.device.info().is_software; }
  void connect(EngineEvents events) override;
  bool takes(const Frame&) const override { return true; }
  uint64_t preparedBytes(const FrameFormat& format) const override {
    return WalkedFrame::bytesFor(works_.device, format);
  }
  std::unique_ptr<FramePreparer> preparer() override;
  bool isReadyFor(const Frame& frame, std::function<void()> then) override;
  PlanPtr plan(const PicturePtr& picture, const PreparedFrame& frame) const override;
  bool isReady(const AtlasOrder& order, std::function<void()> then) override;
  bool hasRoomForEyes(const std::string&) override { return true; }
  std::unique_ptr<Making> begin(AtlasOrder order, HandOn hand_on) override;
  std::optional<std::chrono::nanoseconds> workAhead() override;
  void drain() override;

 private:
  // Does the next part of the warm-up; false: it is over.
  bool warmNext(const std::stop_token& stop);
  // Warms up on a thread of its own.
  void startWarmer();

  StructureWorks works_;
  ViewTracer tracer_;
  std::optional<WarmUp> warm_up_;
  EngineEvents events_;
  StripTraces strips_;
  const std::shared_ptr<GathererShelf> gatherers_;
  const std::shared_ptr<WalkCosts> costs_;  // of all pictures
  PartMeter meter_;
  DeviceWatch watch_;                       // from here on: what they tell uses all of the above
  std::optional<KernelCompiler> compiler_;  // of kOwnThreads
  std::jthread warmer_;                     // likewise, from connect() on
};

}  // namespace viewloom
