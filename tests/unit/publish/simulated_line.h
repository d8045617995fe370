// SPDX-License-Identifier: Apache-2.0
// A line to a reader in tests: bytes leave at its speed, and the socket takes some before.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/send_queue.h"

namespace viewloom::test {

// Time goes on by itself alone. Thread-safety: none.
class SimulatedLine {
 public:
  explicit SimulatedLine(double mbit_per_second) { setSpeed(mbit_per_second, 0); }

  void setSpeed(double mbit_per_second, int64_t now_ns) {
    drainUntil(now_ns);
    bytes_per_ns_ = mbit_per_second * 1e6 / 8 / 1e9;
  }
  // Writes as much. Returns when the socket has taken all of it, if the speed stays.
  int64_t write(uint64_t bytes, int64_t now_ns) {
    drainUntil(now_ns);
    queued_bytes_ += double(bytes);
    const double beyond = std::max(queued_bytes_ - double(kUnsentBytesMax), 0.0);
    return now_ns + int64_t(beyond / bytes_per_ns_);
  }
  // When all that was written is through, if the speed stays.
  int64_t throughNs(int64_t now_ns) {
    drainUntil(now_ns);
    return now_ns + int64_t(queued_bytes_ / bytes_per_ns_);
  }

 private:
  void drainUntil(int64_t now_ns) {
    queued_bytes_ = std::max(queued_bytes_ - double(now_ns - drained_ns_) * bytes_per_ns_, 0.0);
    drained_ns_ = now_ns;
  }

  double bytes_per_ns_ = 1;
  double queued_bytes_ = 0;
  int64_t drained_ns_ = 0;
};

}  // namespace viewloom::test
