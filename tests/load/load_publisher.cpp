// SPDX-License-Identifier: Apache-2.0
#include "load/load_publisher.h"

#include <chrono>
#include <utility>

#include "base/clock.h"

namespace viewloom::load {
namespace {

// Reports of the last frames are due within the time the server needs for them.
constexpr int64_t kFinishTimeoutNs = 60'000'000'000;

}  // namespace

LoadPublisher::LoadPublisher(const std::shared_ptr<grpc::Channel>& channel, std::string stream,
                             std::vector<WireFrame> frames, double rate_hz)
    : frames_(std::move(frames)),
      publisher_(channel, {.stream = stream},
                 {.on_report = [this](const v1::FrameReport& report) { note(report); }}) {
  book_.stream = std::move(stream);
  thread_ =
      std::jthread([this, rate_hz](const std::stop_token& stop) { offerFrames(stop, rate_hz); });
}

void LoadPublisher::offerFrames(const std::stop_token& stop, double rate_hz) {
  const SteadyClock clock;
  const auto period = std::chrono::nanoseconds(static_cast<int64_t>(1e9 / rate_hz));
  auto due = std::chrono::steady_clock::now();
  for (size_t i = 0; !stop.stop_requested(); ++i, due += period) {
    std::this_thread::sleep_until(due);
    WireFrame frame = frames_[i % frames_.size()];
    frame.header.set_capture_time_ns(clock.nowNs());
    publisher_.offer(std::move(frame));
  }
}

void LoadPublisher::note(const v1::FrameReport& report) {
  std::lock_guard lock(mutex_);
  book_.traced += report.outcome() == v1::FRAME_OUTCOME_TRACED;
  book_.built_without_display += report.outcome() == v1::FRAME_OUTCOME_BUILT_WITHOUT_DISPLAY;
  const uint32_t count = ++reports_[report.number()];
  ++(count == 1 ? book_.reported_frames : book_.repeated_reports);
}

PublisherBook LoadPublisher::finish() {
  thread_.request_stop();
  thread_.join();
  const absl::Status end = publisher_.finish(kFinishTimeoutNs);
  std::lock_guard lock(mutex_);
  book_.end = end;
  book_.counts = publisher_.counts();
  return book_;
}

}  // namespace viewloom::load
