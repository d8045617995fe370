// SPDX-License-Identifier: Apache-2.0
// A pipeline with its neighbours, on a validated device and a clock that stands still.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "admission/memory_budget.h"
#include "base/clock.h"
#include "base/str_cat.h"
#include "e2e/collecting_subscriber.h"
#include "engine/make_engines.h"
#include "pipeline/pipeline.h"
#include "support/test_device.h"
#include "support/test_frames.h"

namespace viewloom::test {

inline double tracedCount(const Metrics& metrics) {
  return metrics.atlases_traced[TraceMethod::kWalk].value() +
         metrics.atlases_traced[TraceMethod::kSweep].value();
}

// Current value of a metric. `name` includes labels: "viewloom_x_count{stage=\"build\"}".
inline double metricValue(const Metrics& metrics, const std::string& name) {
  const std::string text = strCat("\n", metrics.text());
  const size_t at = text.find(strCat("\n", name, " "));
  if (at == std::string::npos) throw std::invalid_argument(name);
  return std::stod(text.substr(at + name.size() + 2));
}

// Reports as they come. Thread-safety: all methods may be called from any thread.
class ReportLog {
 public:
  ReportFrame recorder() {
    return [this](const FrameReport& report) {
      std::lock_guard lock(mutex_);
      reports_.push_back(report);
      changed_.notify_all();
    };
  }

  std::vector<FrameReport> waitForReports(size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::seconds(120), [&] { return reports_.size() >= count; });
    return reports_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<FrameReport> reports_;
};

struct ServerOptions {
  uint32_t encode_thread_count = 2;
  uint32_t trace_slot_count = EngineOptions{}.trace_slot_count;
  AtlasLimits atlas_limits = {};
  // Pictures of video wait in it to be coded. Outlives the server.
  MemoryBudget& memory = unboundedMemory();
  // Not empty: makes the engines, in place of makeEngines().
  std::function<Engines(const Device& device)> make_engines = {};
};

class PipelineFixture : public GpuTest {
 protected:
  struct Server {
    // By its own clock, or another.
    explicit Server(const Device& device, ServerOptions options = {},
                    const Clock* other_clock = nullptr)
        : engines(options.make_engines
                      ? options.make_engines(device)
                      : makeEngines(device, {.trace_slot_count = options.trace_slot_count})),
          pipeline(
              {.engines = engines,
               .clock = other_clock != nullptr ? *other_clock : clock,
               .metrics = metrics,
               .broadcaster = broadcaster,
               .directory = directory,
               .on_failure = [](const std::exception& error) { ADD_FAILURE() << error.what(); },
               .memory = options.memory},
              {.encode_thread_count = options.encode_thread_count,
               .atlas_limits = options.atlas_limits}) {
      broadcaster.onDemandChange(
          [this](const std::string& stream) { pipeline.serveDisplays(stream); });
    }

    ManualClock clock;
    Metrics metrics;
    Broadcaster broadcaster{{}};
    StreamDirectory directory{clock, 16};
    ReportLog reports;
    Engines engines;
    Pipeline pipeline;

    void offer(FramePtr frame, const std::string& stream = "scene", uint64_t session = 1) {
      pipeline.offerFrame({stream, session}, std::move(frame), reports.recorder());
    }
  };

  struct Viewer {
    std::shared_ptr<CollectingSubscriber> subscriber = std::make_shared<CollectingSubscriber>();
    std::unique_ptr<Broadcaster::Subscription> subscription;
  };

  static Viewer watch(Server& server, const DisplaySpec& spec, const EncodingSpec& encoding = {},
                      const std::string& stream = "scene") {
    Viewer viewer;
    auto subscription = server.broadcaster.subscribe(stream, spec, encoding, viewer.subscriber);
    EXPECT_TRUE(subscription.ok()) << subscription.status();
    if (subscription.ok()) viewer.subscription = *std::move(subscription);
    return viewer;
  }
};

}  // namespace viewloom::test
