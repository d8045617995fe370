// SPDX-License-Identifier: Apache-2.0
// Repeats a call with delays while its failures are temporary.
#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>

#include "base/status.h"

namespace viewloom {

struct BackoffOptions {
  int64_t first_ns = 200'000'000;  // mean of the first delay
  // Largest mean delay; no delay is longer than 1.5 times this. A client is back within 2 s of the
  // return of its server.
  int64_t max_ns = 1'000'000'000;
  double factor = 2.0;  // growth from delay to delay, > 1
};

// Delays before the next attempt: exponential, with jitter.
// Thread-safety: none; one owner.
class Backoff {
 public:
  // Returns random numbers, uniform in [0, 1).
  using Random = std::function<double()>;

  Backoff(const BackoffOptions& options, Random random);

  // Returns the next delay. The n-th one since reset() is uniform in
  // [0.5, 1.5) x min(first x factor^n, max). So clients that lost the same server do not all call
  // again at the same time.
  int64_t nextDelayNs();
  void reset();

 private:
  BackoffOptions options_;
  Random random_;
  double mean_ns_;
};

// Makes random numbers that differ from process to process.
Backoff::Random makeRandom();

// News about the connection of a client.
struct ConnectionEvent {
  enum class Kind { kConnected, kRetrying };
  Kind kind = Kind::kConnected;
  absl::Status reason;   // kRetrying: how the last call ended
  int64_t delay_ns = 0;  // kRetrying: time until the next attempt
};
using OnConnection = std::function<void(const ConnectionEvent&)>;

// End of a call.
struct CallEnd {
  absl::Status status;
  bool was_connected = false;  // the server had answered: the next failure is a new one
};

// Whether the same call may succeed later. A refusal by the server is final, unless the server is
// shutting down or says when to ask again. Failures of a proxy or the connection are temporary.
bool isPassing(const absl::Status& status);

// Repeats one call. Thread-safety: run() belongs to one thread.
class RetryLoop {
 public:
  // Waits; returns early if stopped.
  using Sleep = std::function<void(const std::stop_token&, int64_t delay_ns)>;

  RetryLoop(const BackoffOptions& options, OnConnection on_connection,
            Backoff::Random random = makeRandom(), Sleep sleep = &sleepUntilStopped);

  // Calls until the call ends OK, fails for good, or is stopped (CANCELLED). Returns the last
  // status.
  absl::Status run(const std::stop_token& stop, const std::function<CallEnd()>& call);

  static void sleepUntilStopped(const std::stop_token& stop, int64_t delay_ns);

 private:
  Backoff backoff_;
  OnConnection on_connection_;
  Sleep sleep_;
};

}  // namespace viewloom
