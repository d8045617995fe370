// SPDX-License-Identifier: Apache-2.0
// A line of the log that a client may cause again and again, and must not fill the disk with.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

namespace viewloom {

// Lets one line through in each pause, and counts the others. Thread-safety: may be called from any
// thread.
class RareLog {
 public:
  explicit RareLog(std::chrono::nanoseconds pause) : pause_ns_(pause.count()) {}

  // The line to write, with the count of those that were left out before it; nullopt within a pause
  // since the last one. `now_ns` is of a clock that never goes back.
  std::optional<std::string> take(const std::string& line, int64_t now_ns);

 private:
  const int64_t pause_ns_;
  std::mutex mutex_;
  std::optional<int64_t> last_ns_;
  uint64_t left_out_count_ = 0;
};

}  // namespace viewloom
