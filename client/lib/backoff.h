// SPDX-License-Identifier: Apache-2.0
// How long to wait before the next attempt: exponential, with jitter.
#pragma once

#include <cstdint>
#include <functional>

namespace viewloom {

struct BackoffOptions {
  int64_t first_ns = 200'000'000;  // mean of the first delay
  // No delay is longer than 1.5 times this: whoever waits for a server is back within 2 s of its
  // return.
  int64_t max_ns = 1'000'000'000;
  double factor = 2.0;  // from delay to delay, > 1
};

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

}  // namespace viewloom
