// SPDX-License-Identifier: Apache-2.0
// Listens on the gRPC address, accepts connections and hands them on.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "admission/memory_budget.h"
#include "base/status.h"
#include "metrics/metrics.h"
#include "rpc/open_sockets.h"

namespace viewloom {

struct RpcListenerOptions {
  std::string address;  // HOST:PORT, or unix:PATH; port 0 = any free one
  uint32_t connection_count_max = 1024;
  // How long a connection may leave bytes unacknowledged before the system cuts it.
  std::chrono::milliseconds acknowledge_time{5000};
};

// The library's own listener (1.51) stops for good when accept() fails once, as it does without a
// free file descriptor. This one goes on. It also keeps the number of connections below a limit, so
// that descriptors stay free, and reserves kConnectionBytes of memory for each, in the share of its
// address. A connection beyond that is closed at once.
//
// Thread-safety: status() and connectionCount() may be called from any thread; the rest from one.
class RpcListener {
 public:
  // Takes a connection that was accepted on that listening socket. If it throws, it has not.
  using HandOver = std::function<void(int listener_fd, int fd)>;

  // Listens, and accepts nothing yet. Throws std::runtime_error when the address cannot be had.
  // Both others outlive it.
  RpcListener(const RpcListenerOptions& options, const Metrics& metrics, MemoryBudget& memory);
  // Stops.
  ~RpcListener();
  RpcListener(const RpcListener&) = delete;
  RpcListener& operator=(const RpcListener&) = delete;

  // Accepts from now on, on a thread of its own, which calls `hand_over`.
  void start(HandOver hand_over);
  // Closes the port. Connections stay as they are.
  void stop();

  uint16_t port() const { return port_; }  // 0 = a UNIX socket
  size_t connectionCount() const;
  // Whether a further client would get in: RESOURCE_EXHAUSTED if all connections are taken, or if
  // the process has no free descriptor.
  absl::Status status() const;

 private:
  void run(const std::stop_token& stop);
  void acceptFrom(int listener_fd);
  // A connection for which nothing is left is closed, and others are accepted.
  void takeOrClose(int listener_fd, int fd);
  void take(int listener_fd, int fd);
  std::optional<Reservation> reserve(int fd);
  // Under mutex_, as the next. Connections that were closed count until they are looked for.
  bool isFull() const;
  void forgetClosed() const;

  const RpcListenerOptions options_;
  const Metrics& metrics_;
  MemoryBudget& memory_;
  std::vector<int> listener_fds_;
  int wake_fd_ = -1;
  uint16_t port_ = 0;
  HandOver hand_over_;
  mutable std::mutex mutex_;
  mutable OpenSockets connections_;  // guarded by mutex_, as is the next
  mutable std::chrono::steady_clock::time_point counted_{};
  std::atomic<bool> lacks_descriptors_ = false;
  std::jthread thread_;  // last: it uses all the others
};

}  // namespace viewloom
