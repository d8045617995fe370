// SPDX-License-Identifier: Apache-2.0
#include "offline/loopback_bench.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "base/clock.h"
#include "lib/channel.h"
#include "lib/publisher.h"
#include "lib/watcher.h"
#include "service.h"

namespace viewloom {
namespace {

constexpr char kStream[] = "bench";
// A first atlas takes a compilation of the kernels, on a busy machine with a software device some
// minutes; more is a server that does not serve.
constexpr auto kFirstAtlasTimeout = std::chrono::minutes(5);
// How often the feed looks whether the publisher has room again: far below the time of a frame.
constexpr auto kFeedInterval = std::chrono::milliseconds(1);

// Sums over the atlases since start(). Thread-safety: all methods may be called from any thread.
class AtlasTally {
 public:
  void add(const Atlas& atlas) {
    const v1::StageTimes& times = atlas.end.times();
    std::lock_guard lock(mutex_);
    has_come_ = true;
    come_.notify_all();
    if (!is_counting_) return;
    ++sums_.atlas_count;
    sums_.atlas_bytes += atlas.byteCount();
    sums_.receive_ms += milliseconds(times.receive_ns());
    sums_.decode_ms += milliseconds(times.decode_ns());
    sums_.upload_ms += milliseconds(times.upload_ns());
    sums_.build_ms += milliseconds(times.build_ns());
    sums_.wait_ms += milliseconds(times.wait_ns());
    sums_.trace_ms += milliseconds(times.trace_ns());
    sums_.encode_ms += milliseconds(times.encode_ns());
    sums_.total_ms += milliseconds(times.total_ns());
  }

  bool waitForFirst() {
    std::unique_lock lock(mutex_);
    return come_.wait_for(lock, kFirstAtlasTimeout, [this] { return has_come_; });
  }

  void start() {
    std::lock_guard lock(mutex_);
    is_counting_ = true;
  }

  // Means of the stages.
  LoopbackReport stop() {
    std::lock_guard lock(mutex_);
    is_counting_ = false;
    LoopbackReport means = sums_;
    const double count = static_cast<double>(std::max<uint64_t>(means.atlas_count, 1));
    double staged_ms = 0;
    for (double* stage : {&means.receive_ms, &means.decode_ms, &means.upload_ms, &means.build_ms,
                          &means.wait_ms, &means.trace_ms, &means.encode_ms}) {
      *stage /= count;
      staged_ms += *stage;
    }
    means.total_ms /= count;
    if (means.total_ms > 0) means.other_share = std::max(0.0, 1 - staged_ms / means.total_ms);
    return means;
  }

 private:
  static double milliseconds(int64_t ns) { return static_cast<double>(ns) * 1e-6; }

  std::mutex mutex_;
  std::condition_variable come_;
  bool has_come_ = false;
  bool is_counting_ = false;
  LoopbackReport sums_;
};

Config loopbackConfig(Config config) {
  config.grpc.address = "127.0.0.1:0";
  config.http.enabled = false;
  config.tls = {};
  return config;
}

v1::OpenDisplay openDisplay(const v1::Display& display) {
  v1::OpenDisplay open;
  open.set_stream(kStream);
  *open.mutable_display() = display;
  open.set_wait_for_stream(true);
  return open;
}

void feed(const std::stop_token& stop, Publisher& publisher, const std::vector<WireFrame>& frames) {
  for (size_t next = 0; !stop.stop_requested();) {
    if (publisher.isWaiting()) {
      std::this_thread::sleep_for(kFeedInterval);
    } else {
      publisher.offer(frames[next++ % frames.size()]);
    }
  }
}

}  // namespace

absl::StatusOr<LoopbackReport> measureLoopback(const Config& config, const v1::Display& display,
                                               const std::vector<WireFrame>& frames,
                                               double seconds) {
  const SteadyClock clock;
  std::atomic<bool> has_failed = false;
  Service service(loopbackConfig(config), clock, [&](const std::exception&) { has_failed = true; });
  AtlasTally tally;
  Watcher watcher(makeChannel(service.grpcAddress()), openDisplay(display),
                  {.on_layout = {},
                   .on_atlas = [&](const Atlas& atlas) { tally.add(atlas); },
                   .on_connection = {}});
  Publisher publisher(makeChannel(service.grpcAddress()), {.stream = kStream}, {});
  std::jthread feeder([&](const std::stop_token& stop) { feed(stop, publisher, frames); });

  if (!tally.waitForFirst() || has_failed) {
    if (const auto ended = watcher.ended()) return *ended;
    if (const auto ended = publisher.ended()) return *ended;
    return absl::DeadlineExceededError("no atlas came within five minutes");
  }
  const uint64_t skipped_before = watcher.counts().atlases.skipped;
  const int64_t started_ns = clock.nowNs();
  tally.start();
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  LoopbackReport report = tally.stop();
  report.seconds = static_cast<double>(clock.nowNs() - started_ns) * 1e-9;
  report.skipped_count = watcher.counts().atlases.skipped - skipped_before;
  return report;
}

}  // namespace viewloom
