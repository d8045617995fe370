// SPDX-License-Identifier: Apache-2.0
#include "show/display_link.h"

#include <utility>

namespace viewloom::show {
namespace {

constexpr size_t kPresentedMax = 64;

}  // namespace

DisplayLink::DisplayLink(std::shared_ptr<grpc::Channel> channel, v1::OpenDisplay open,
                         WatcherCallbacks callbacks)
    : watcher_(std::move(channel), std::move(open), std::move(callbacks)),
      clock_(watcher_),
      sender_([this](const std::stop_token& stop) { send(stop); }) {}

DisplayLink::~DisplayLink() {
  watcher_.stop();  // or the sender may wait for a network that is not there
}

void DisplayLink::change(v1::ChangeDisplay change) {
  std::lock_guard lock(mutex_);
  change_ = std::move(change);
  filled_.notify_one();
}

void DisplayLink::sendEyePoses(v1::EyePoses poses) {
  std::lock_guard lock(mutex_);
  eyes_ = std::move(poses);
  filled_.notify_one();
}

void DisplayLink::reportPresented(uint64_t sequence, int64_t presented_time_ns) {
  std::lock_guard lock(mutex_);
  if (presented_.size() == kPresentedMax) presented_.pop_front();
  presented_.push_back({sequence, presented_time_ns});
  filled_.notify_one();
}

void DisplayLink::send(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (filled_.wait(lock, stop, [this] { return change_ || eyes_ || !presented_.empty(); })) {
    const std::optional<v1::ChangeDisplay> change = std::exchange(change_, std::nullopt);
    const std::optional<v1::EyePoses> eyes = std::exchange(eyes_, std::nullopt);
    const std::deque<Presented> presented = std::exchange(presented_, {});
    lock.unlock();
    if (change) watcher_.change(*change);
    if (eyes) watcher_.sendEyePoses(*eyes);
    for (const Presented& shown : presented) {
      watcher_.reportPresented(shown.sequence, shown.time_ns);
    }
    lock.lock();
    if (stop.stop_requested()) return;
  }
}

}  // namespace viewloom::show
