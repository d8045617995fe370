// SPDX-License-Identifier: Apache-2.0
// How large the chunks of a frame may be, so that heartbeats are not held up by slow lines.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace viewloom {

// A server hears of a message when all of it has come. Chunks begin small and grow while they go
// fast: on a line of 1 Mbit/s the largest would take 8 s. Thread-safety: none; one owner.
class ChunkSize {
 public:
  static constexpr size_t kMin_bytes = size_t{1} << 16;
  static constexpr size_t kMax_bytes = size_t{1} << 20;  // the most that a server takes

  size_t bytes() const { return bytes_; }
  // A chunk of this size has gone, in that time.
  void note(int64_t duration_ns) {
    if (duration_ns < kFast_ns) bytes_ = std::min(2 * bytes_, kMax_bytes);
    if (duration_ns > kSlow_ns) bytes_ = std::max(bytes_ / 2, kMin_bytes);
  }

 private:
  static constexpr int64_t kFast_ns = 100'000'000;
  static constexpr int64_t kSlow_ns = 400'000'000;

  size_t bytes_ = kMin_bytes;
};

}  // namespace viewloom
