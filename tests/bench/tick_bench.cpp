// SPDX-License-Identifier: Apache-2.0
#include "bench/tick_bench.h"

#include <chrono>
#include <cstdio>
#include <iostream>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/clock.h"
#include "base/log.h"
#include "base/processor_count.h"
#include "bench/failed_pipeline.h"
#include "bench/report.h"
#include "bench/retime_bench.h"
#include "engine/make_engines.h"
#include "load/percentiles.h"
#include "metrics/metrics.h"
#include "pipeline/pipeline.h"
#include "support/test_frames.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kFrameRate_hz = 15;   // of both streams
constexpr double kOutputRate_hz = 60;  // of both displays
constexpr double kCameraSpeed_mps = 0.2;
constexpr std::chrono::seconds kWarmUp{2};
constexpr SizePx kMoving_px{1920, 1080};
constexpr SizePx kBystander_px{480, 270};
constexpr SizePx kQuilt_px{960, 960};
constexpr uint32_t kLayers = 2;

struct Arguments {
  std::string device;
  uint32_t round_count = 3;
  double seconds = 5;
  uint32_t miniature = 1;
  bool prints_json = false;
};

// Keeps book of one display, since start(). Thread-safety: all methods may be called from any
// thread.
class Book final : public Subscriber {
 public:
  explicit Book(const Clock& clock) : clock_(clock) {}

  void offer(AtlasPtr atlas) override {
    const int64_t now_ns = clock_.nowNs();
    std::lock_guard lock(mutex_);
    if (is_counting_) ages_.add(now_ns - atlas->shown_time_ns);
  }
  void end(const absl::Status&) override {}

  void start() {
    std::lock_guard lock(mutex_);
    is_counting_ = true;
  }
  load::Percentiles take() {
    std::lock_guard lock(mutex_);
    return std::exchange(ages_, {});
  }

 private:
  const Clock& clock_;
  std::mutex mutex_;
  bool is_counting_ = false;
  load::Percentiles ages_;
};

// A stream and its one display.
class Show {
 public:
  Show(std::string stream, std::vector<FramePtr> frames, Broadcaster& broadcaster,
       const Clock& clock, SizePx quilt_px)
      : stream_(std::move(stream)), frames_(std::move(frames)), clock_(clock) {
    DisplaySpec spec{.kind = QuiltSpec{.columns = 8, .rows = 6, .size_px = quilt_px}};
    spec.temporal = TemporalSpec{.output_rate_hz = kOutputRate_hz};
    auto subscription =
        broadcaster.subscribe(stream_, completeDisplaySpec(spec).value(), EncodingSpec{}, book_);
    if (!subscription.ok()) {
      throw std::runtime_error(std::string(subscription.status().message()));
    }
    subscription_ = *std::move(subscription);
  }

  Book& book() { return *book_; }

  // Frame `index`, captured now, by a camera that goes on.
  void publish(Pipeline& pipeline, uint64_t index) const {
    auto frame = std::make_shared<Frame>(*frames_[index % frames_.size()]);
    const int64_t now_ns = clock_.nowNs();
    frame->format.number = index + 1;
    frame->format.capture_time_ns = now_ns;
    frame->format.sources.front().camera.pose.position_m.x +=
        kCameraSpeed_mps * double(index) / kFrameRate_hz;
    frame->times = {now_ns, now_ns, now_ns};
    pipeline.offerFrame({stream_, 1}, std::move(frame), [](const FrameReport&) {});
  }

 private:
  const std::string stream_;
  const std::vector<FramePtr> frames_;
  const Clock& clock_;
  const std::shared_ptr<Book> book_ = std::make_shared<Book>(clock_);
  std::unique_ptr<Broadcaster::Subscription> subscription_;
};

struct Figures {
  load::Percentiles bystander;  // ages of what its atlases show, when they are out
  load::Percentiles moving;
  double skipped_count = 0;  // ticks
};

// Two frames that differ.
std::vector<FramePtr> framesOf(SizePx size_px, double moving_share) {
  std::vector<FramePtr> frames;
  for (const double time_s : {0.0, 0.5}) {
    frames.push_back(withMotion(*test::syntheticFrame(1, size_px, kLayers, time_s), moving_share));
  }
  return frames;
}

// The bystander alone where no share moves.
Figures serve(const Device& device, double moving_share, const Arguments& arguments) {
  const auto smaller = [&](SizePx size_px) {
    return SizePx{size_px.width / arguments.miniature, size_px.height / arguments.miniature};
  };
  const SteadyClock clock;
  Metrics metrics;
  Broadcaster broadcaster{{}};
  StreamDirectory directory{clock, 2};
  const Engines engines = makeEngines(device);
  Pipeline pipeline({.engines = engines,
                     .clock = clock,
                     .metrics = metrics,
                     .broadcaster = broadcaster,
                     .directory = directory,
                     .on_failure = endOfFailedPipeline},
                    {.encode_thread_count = processorCount()});
  broadcaster.onDemandChange([&](const std::string& stream) { pipeline.serveDisplays(stream); });
  std::vector<Show> shows;
  shows.reserve(2);
  shows.emplace_back("bystander", framesOf(smaller(kBystander_px), 0), broadcaster, clock,
                     smaller(kQuilt_px));
  if (moving_share > 0) {
    shows.emplace_back("moving", framesOf(smaller(kMoving_px), moving_share), broadcaster, clock,
                       smaller(kQuilt_px));
  }
  const auto begin = std::chrono::steady_clock::now();
  const auto warm_up = uint64_t(double(kWarmUp.count()) * kFrameRate_hz);
  const auto frame_count = warm_up + uint64_t(arguments.seconds * kFrameRate_hz);
  double skipped_before = 0;
  for (uint64_t index = 0; index < frame_count; ++index) {
    std::this_thread::sleep_until(
        begin + std::chrono::nanoseconds(int64_t(1e9 / kFrameRate_hz * double(index))));
    if (index == warm_up) {
      skipped_before = metrics.output_ticks_skipped.value();
      for (Show& show : shows) show.book().start();
    }
    for (const Show& show : shows) show.publish(pipeline, index);
  }
  Figures figures{.bystander = shows.front().book().take(),
                  .moving = {},
                  .skipped_count = metrics.output_ticks_skipped.value() - skipped_before};
  if (shows.size() > 1) figures.moving = shows.back().book().take();
  return figures;
}

Json resultOf(const load::Percentiles& ages, double seconds) {
  return {{"atlases_per_s", double(ages.count()) / seconds},
          {"age_ms", {{"p50", ages.atMs(0.5)}, {"p90", ages.atMs(0.9)}, {"p99", ages.atMs(0.99)}}}};
}

void measure(const Arguments& arguments) {
  setLogLevel(LogLevel::kWarning);
  const Device device({.select = arguments.device});
  const std::vector<double> shares{0, 0.1, 1};
  std::vector<Figures> all(shares.size());
  for (uint32_t round = 0; round < arguments.round_count; ++round) {
    for (size_t i = 0; i < shares.size(); ++i) {
      const Figures figures = serve(device, shares[i], arguments);
      all[i].bystander.add(figures.bystander);
      all[i].moving.add(figures.moving);
      all[i].skipped_count += figures.skipped_count;
    }
  }
  const double seconds = arguments.seconds * arguments.round_count;
  Json json{{"device", device.info().name}, {"date", today()}, {"shares", Json::array()}};
  for (size_t i = 0; i < shares.size(); ++i) {
    json["shares"].push_back({{"moving_share", shares[i]},
                              {"bystander", resultOf(all[i].bystander, seconds)},
                              {"moving", resultOf(all[i].moving, seconds)},
                              {"skipped_per_s", all[i].skipped_count / seconds}});
    if (!arguments.prints_json) std::cout << json["shares"].back().dump() << std::endl;
  }
  if (arguments.prints_json) std::cout << json.dump(2) << "\n";
}

}  // namespace

void addTicksCommand(const usage::Command& app) {
  const auto arguments = std::make_shared<Arguments>();
  const usage::Command command = app.addCommand(
      "ticks",
      "Serve a display at 60 Hz alone and beside a stream in which things move, also at 60 Hz: how "
      "old what they show is when it is out");
  command.add("--device", arguments->device, "Vulkan device, as viewloomd --device");
  command.addFlag("--json", arguments->prints_json, "Print one JSON object at the end");
  command.add("--rounds", arguments->round_count, "Loads in turn, so often").between(1, 1000);
  command.add("--seconds", arguments->seconds, "Of each load in each round").between(0.1, 600.0);
  command
      .add("--miniature", arguments->miniature,
           "Frames and displays so many times smaller on a side: tries the program out")
      .between(1, 8);
  command.onChosen([arguments] { measure(*arguments); });
}

}  // namespace viewloom::bench
