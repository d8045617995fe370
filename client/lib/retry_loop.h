// SPDX-License-Identifier: Apache-2.0
// Makes a call again, after a while, for as long as its failure is one that passes.
#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>

#include "base/status.h"

namespace viewloom {

struct BackoffOptions {
  int64_t first_ns = 200'000'000;  // mean of the first delay
  // No delay is longer than 1.5 times this: whoever waits for a server is back within 2 s of its
  // return.
  int64_t max_ns = 1'000'000'000;
  double factor = 2.0;  // from delay to delay, > 1
};

// How long to wait before the next attempt: exponential, with jitter.
// Thread-safety: none; one owner.
class Backoff {
 public:
  // Uniform in [0, 1).
  using Random = std::function<double()>;

  Backoff(const BackoffOptions& options, Random random);

  // The n-th delay since reset() is uniform in [0.5, 1.5) x min(first x factor^n, max): clients
  // that lost the same server do not come back in step.
  int64_t nextDelayNs();
  void reset();

 private:
  BackoffOptions options_;
  Random random_;
  double mean_ns_;
};

// Random numbers that differ from process to process.
Backoff::Random makeRandom();

// What a client is doing, told to whoever listens.
struct ConnectionEvent {
  enum class Kind { kConnected, kRetrying };
  Kind kind = Kind::kConnected;
  absl::Status reason;   // kRetrying: how the last call ended
  int64_t delay_ns = 0;  // kRetrying: until the next attempt
};
using OnConnection = std::function<void(const ConnectionEvent&)>;

// How a call ended.
struct CallEnd {
  absl::Status status;
  bool was_connected = false;  // the server had answered: the next failure is a new one
};

// Whether the same call may succeed later. What the server itself refuses may not, unless it drains
// or says when to ask again; what a proxy or the connection did to a call may.
bool isPassing(const absl::Status& status);

// Thread-safety: run() belongs to one thread.
class RetryLoop {
 public:
  // Waits; returns early when stopped.
  using Sleep = std::function<void(const std::stop_token&, int64_t delay_ns)>;

  RetryLoop(const BackoffOptions& options, OnConnection on_connection,
            Backoff::Random random = makeRandom(), Sleep sleep = &sleepUntilStopped);

  // Calls until it ends OK, fails for good, or is stopped (CANCELLED). Returns the last status.
  absl::Status run(const std::stop_token& stop, const std::function<CallEnd()>& call);

  static void sleepUntilStopped(const std::stop_token& stop, int64_t delay_ns);

 private:
  Backoff backoff_;
  OnConnection on_connection_;
  Sleep sleep_;
};

}  // namespace viewloom
