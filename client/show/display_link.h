// SPDX-License-Identifier: Apache-2.0
// A watched display whose changes and reports never keep the caller waiting for the network.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "lib/watcher.h"

namespace viewloom::show {

// Thread-safety: all methods may be called from any thread, but the destructor from one only.
class DisplayLink {
 public:
  // The callbacks are the watcher's, and come from its thread.
  DisplayLink(std::shared_ptr<grpc::Channel> channel, v1::OpenDisplay open,
              WatcherCallbacks callbacks);
  // Breaks off.
  ~DisplayLink();
  DisplayLink(const DisplayLink&) = delete;
  DisplayLink& operator=(const DisplayLink&) = delete;

  // Another display, also for calls after a broken connection. Newest wins: what has not been sent
  // is replaced.
  void change(v1::ChangeDisplay change);
  // Where the eyes before a tracked display are. Newest wins.
  void sendEyePoses(v1::EyePoses poses);
  // Reports when an atlas was shown, by this machine's clock. While 64 reports wait to be sent, the
  // oldest goes.
  void reportPresented(uint64_t sequence, int64_t presented_time_ns);
  // State of the watcher.
  std::optional<absl::Status> ended() const { return watcher_.ended(); }
  WatcherCounts counts() const { return watcher_.counts(); }
  std::optional<ClockOffset> serverClock() const { return watcher_.serverClock(); }

 private:
  void send(const std::stop_token& stop);

  struct Presented {
    uint64_t sequence = 0;
    int64_t time_ns = 0;
  };

  std::mutex mutex_;
  std::condition_variable_any filled_;
  std::optional<v1::ChangeDisplay> change_;
  std::optional<v1::EyePoses> eyes_;
  std::deque<Presented> presented_;

  Watcher watcher_;
  ClockFollower clock_;
  std::jthread sender_;  // last: joins before what it uses goes
};

}  // namespace viewloom::show
