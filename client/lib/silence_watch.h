// SPDX-License-Identifier: Apache-2.0
// Notices when a server that sends heartbeats falls silent.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <thread>

#include "base/status.h"

namespace viewloom {

struct SilenceOptions {
  // Silence is counted in ticks, so that a client that was paused does not report silence.
  std::chrono::milliseconds tick{250};
  uint32_t tick_count_max = 20;  // 5 s; heartbeats come once a second
};

// Calls `on_silence` once if no message comes. Only time spent waiting for a message counts, and
// only after the first heartbeat: servers without heartbeats may be silent.
//
// Thread-safety: another thread calls `on_silence`. listens(), hears() and expectHeartbeats()
// belong to the thread that reads.
class SilenceWatch {
 public:
  explicit SilenceWatch(std::function<void()> on_silence, const SilenceOptions& options = {});

  // The wait for the next message begins.
  void listens();
  // A message came, or the call has ended.
  void hears() { is_listening_ = false; }
  void expectHeartbeats() { has_heartbeats_ = true; }

  bool hasFired() const { return has_fired_; }
  // Status for the call that ended because of silence: UNAVAILABLE.
  absl::Status status() const;

 private:
  void run(const std::stop_token& stop);

  const std::function<void()> on_silence_;
  const SilenceOptions options_;
  std::atomic<bool> is_listening_ = false;
  std::atomic<bool> has_heartbeats_ = false;
  std::atomic<bool> has_fired_ = false;
  std::atomic<uint32_t> tick_count_ = 0;
  std::jthread thread_;  // last: it uses the members above
};

}  // namespace viewloom
