// SPDX-License-Identifier: Apache-2.0
// Notices that a server which sends heartbeats has fallen silent.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <thread>

#include "base/status.h"

namespace viewloom {

struct SilenceOptions {
  // Counted in ticks: a client that was stopped for a while has missed nothing.
  std::chrono::milliseconds tick{250};
  uint32_t tick_count_max = 20;  // 5 s, of a heartbeat a second
};

// Only time spent waiting for a message counts, and only from the first heartbeat on: servers
// without them may be silent. Thread-safety: `on_silence` is called on a thread of its own, once;
// listens(), hears() and expectHeartbeats() belong to one thread, the one that reads.
class SilenceWatch {
 public:
  explicit SilenceWatch(std::function<void()> on_silence, const SilenceOptions& options = {});

  // Waits for the next message from now on.
  void listens();
  // A message came, or the call has ended.
  void hears() { is_listening_ = false; }
  void expectHeartbeats() { has_heartbeats_ = true; }

  bool hasFired() const { return has_fired_; }
  // UNAVAILABLE, for how the call ended.
  absl::Status status() const;

 private:
  void run(const std::stop_token& stop);

  const std::function<void()> on_silence_;
  const SilenceOptions options_;
  std::atomic<bool> is_listening_ = false;
  std::atomic<bool> has_heartbeats_ = false;
  std::atomic<bool> has_fired_ = false;
  std::atomic<uint32_t> tick_count_ = 0;
  std::jthread thread_;  // last: it uses what stands above
};

}  // namespace viewloom
