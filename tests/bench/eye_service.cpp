// SPDX-License-Identifier: Apache-2.0
#include "bench/eye_service.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "base/processor_count.h"
#include "bench/failed_pipeline.h"
#include "engine/make_engines.h"
#include "metrics/metrics.h"
#include "pipeline/pipeline.h"

namespace viewloom::bench {
namespace {

constexpr char kStream[] = "bench";
constexpr double kHalfEyeDistance_m = 0.0315;
constexpr std::chrono::minutes kFirstTimeout{5};  // as long as kernels may take to compile

// Keeps book of one display; its owner counts since start().
class Book final : public Subscriber {
 public:
  explicit Book(const Clock& clock) : clock_(clock) {}

  void offer(AtlasPtr atlas) override {
    const int64_t now_ns = clock_.nowNs();
    std::lock_guard lock(mutex_);
    ++atlas_count_;
    came_.notify_all();
    // Nobody has waited for a newer frame that the same eyes see, since they moved.
    const bool is_answer =
        atlas->eye_poses_time_ns != 0 &&
        std::exchange(last_poses_ns_, atlas->eye_poses_time_ns) != atlas->eye_poses_time_ns;
    if (!is_counting_ || !is_answer) return;
    figures_.waited.add(atlas->eye_poses_age_ns);
    figures_.made.add(atlas->times.trace_ns + atlas->times.encode_ns);
    figures_.answered.add(now_ns - atlas->eye_poses_latched_ns + atlas->eye_poses_age_ns);
  }

  void end(const absl::Status& status) override {
    std::lock_guard lock(mutex_);
    end_ = status;
    came_.notify_all();
  }

  // Waits until so many have come. Throws what the display ended with.
  void waitForAtlases(uint64_t count) {
    std::unique_lock lock(mutex_);
    const bool came = came_.wait_for(lock, kFirstTimeout,
                                     [&] { return atlas_count_ >= count || end_.has_value(); });
    if (end_ && !end_->ok()) throw std::runtime_error(std::string(end_->message()));
    if (!came) throw std::runtime_error("no atlas came within five minutes");
  }

  uint64_t atlasCount() const {
    std::lock_guard lock(mutex_);
    return atlas_count_;
  }

  void start() {
    std::lock_guard lock(mutex_);
    is_counting_ = true;
  }

  EyeFigures stop() {
    std::lock_guard lock(mutex_);
    is_counting_ = false;
    return figures_;
  }

 private:
  const Clock& clock_;
  mutable std::mutex mutex_;
  std::condition_variable came_;
  uint64_t atlas_count_ = 0;
  int64_t last_poses_ns_ = 0;
  bool is_counting_ = false;
  std::optional<absl::Status> end_;
  EyeFigures figures_;
};

struct Viewer {
  std::shared_ptr<Book> book;
  EyeTrackPtr eyes;
  std::unique_ptr<Broadcaster::Subscription> subscription;
};

DisplaySpec trackedEyes(SizePx eye_px) {
  return completeDisplaySpec({.kind = StereoSpec{.eye_size_px = eye_px, .is_tracked = true}})
      .value();
}

DisplaySpec quilt(SizePx size_px) {
  return completeDisplaySpec({.kind = QuiltSpec{.columns = 8, .rows = 6, .size_px = size_px}})
      .value();
}

// When in each interval a head moves, from 0 to 1.
struct Phase {
  double of_interval = 0;
  size_t head = 0;
};

// In the order of time. Clients know nothing of one another: multiples of the golden ratio lie in
// no lattice, and leave no large gap.
std::vector<Phase> phasesOf(const EyeLoad& load) {
  std::vector<Phase> phases;
  for (size_t head = 0; head < load.viewer_count; ++head) {
    const double turns = load.is_all_at_once ? 0 : double(head) * std::numbers::phi;
    phases.push_back({turns - std::floor(turns), head});
  }
  std::stable_sort(phases.begin(), phases.end(),
                   [](const Phase& a, const Phase& b) { return a.of_interval < b.of_interval; });
  return phases;
}

class EyeBench {
 public:
  EyeBench(const Device& device, const std::vector<FramePtr>& frames, const EyeLoad& load)
      : frames_(frames),
        load_(load),
        engines_(makeEngines(device)),
        pipeline_({.engines = engines_,
                   .clock = clock_,
                   .metrics = metrics_,
                   .broadcaster = broadcaster_,
                   .directory = directory_,
                   .on_failure = endOfFailedPipeline},
                  {.encode_thread_count = processorCount()}) {
    broadcaster_.onDemandChange(
        [this](const std::string& stream) { pipeline_.serveDisplays(stream); });
  }

  EyeFigures run() {
    for (uint32_t i = 0; i < load_.viewer_count; ++i) {
      viewers_.push_back(enter(trackedEyes(load_.eye_px), std::make_shared<EyeTrack>()));
    }
    if (load_.quilt_px.area() > 0) quilt_ = enter(quilt(load_.quilt_px), nullptr);
    publishNext();
    for (const Viewer& viewer : viewers_) viewer.book->waitForAtlases(1);
    // The kernels of the eyes' own method compile.
    for (size_t head = 0; head < viewers_.size(); ++head) move(head, 0);
    for (const Viewer& viewer : viewers_) viewer.book->waitForAtlases(2);
    std::jthread frames_come([this](const std::stop_token& stop) { feedQuilt(stop); });
    for (const Viewer& viewer : viewers_) viewer.book->start();
    const uint64_t quilts_before = quilt_.book ? quilt_.book->atlasCount() : 0;
    moveOnTime();
    EyeFigures all;
    for (const Viewer& viewer : viewers_) {
      const EyeFigures figures = viewer.book->stop();
      all.answered.add(figures.answered);
      all.waited.add(figures.waited);
      all.made.add(figures.made);
    }
    if (quilt_.book) all.quilt_count = quilt_.book->atlasCount() - quilts_before;
    frames_come.request_stop();
    frames_come.join();
    return all;
  }

 private:
  Viewer enter(const DisplaySpec& spec, EyeTrackPtr eyes) {
    Viewer viewer{.book = std::make_shared<Book>(clock_), .eyes = eyes, .subscription = nullptr};
    auto subscription =
        broadcaster_.subscribe(kStream, spec, EncodingSpec{}, viewer.book, std::move(eyes));
    if (!subscription.ok()) throw std::runtime_error(std::string(subscription.status().message()));
    viewer.subscription = *std::move(subscription);
    return viewer;
  }

  void publishNext() {
    auto frame = std::make_shared<Frame>(*frames_[frame_count_ % frames_.size()]);
    frame->format.number = ++frame_count_;
    pipeline_.offerFrame({kStream, 1}, std::move(frame), [](const FrameReport&) {});
  }

  // A frame for each quilt that is out.
  void feedQuilt(const std::stop_token& stop) {
    if (!quilt_.book) return;
    for (uint64_t count = 1; !stop.stop_requested(); ++count) {
      quilt_.book->waitForAtlases(count);
      if (!stop.stop_requested()) publishNext();
    }
  }

  // Each head is at a place of its own.
  void move(size_t head, int64_t tick) {
    EyePoses poses = headAt(load_.motion, double(tick) / load_.rate_hz + 0.37 * double(head));
    poses.time_ns = tick + 1;
    poses.received_ns = clock_.nowNs();
    viewers_[head].eyes->put(std::move(poses));
    pipeline_.serveEyes(viewers_[head].subscription->displayId());
  }

  void moveOnTime() {
    const std::vector<Phase> phases = phasesOf(load_);
    const auto begin = std::chrono::steady_clock::now();
    const auto tick_count = int64_t(load_.seconds * load_.rate_hz);
    for (int64_t tick = 1; tick <= tick_count; ++tick) {
      for (const Phase& phase : phases) {
        const double due_ns = 1e9 / load_.rate_hz * (double(tick) + phase.of_interval);
        std::this_thread::sleep_until(begin + std::chrono::nanoseconds(int64_t(due_ns)));
        move(phase.head, tick);
      }
    }
  }

  const std::vector<FramePtr>& frames_;
  const EyeLoad& load_;
  const SteadyClock clock_;
  Metrics metrics_;
  Broadcaster broadcaster_{{}};
  StreamDirectory directory_{clock_, 1};
  const Engines engines_;
  Pipeline pipeline_;
  std::vector<Viewer> viewers_;
  Viewer quilt_;
  uint64_t frame_count_ = 0;
};

}  // namespace

EyePoses headAt(HeadMotion motion, double time_s) {
  Pose head;
  head.position_m.x = 0.08 * std::sin(2.1 * time_s);
  if (motion == HeadMotion::kFree) {
    head.position_m.y = 0.03 * std::sin(1.3 * time_s + 0.5);
    head.position_m.z = 0.05 * std::sin(0.9 * time_s + 1);
    head.orientation =
        glm::dquat(glm::dvec3(0.06 * std::sin(1.1 * time_s), 0.1 * std::sin(1.5 * time_s + 0.3),
                              0.1 * std::sin(1.7 * time_s)));
  }
  EyePoses poses;
  for (size_t eye = 0; eye < poses.eyes.size(); ++eye) {
    const double aside_m = eye == 0 ? -kHalfEyeDistance_m : kHalfEyeDistance_m;
    poses.eyes[eye].pose = compose(head, {.position_m = {aside_m, 0, 0}});
  }
  return poses;
}

EyeFigures measureEyes(const Device& device, const std::vector<FramePtr>& frames,
                       const EyeLoad& load) {
  return EyeBench(device, frames, load).run();
}

}  // namespace viewloom::bench
