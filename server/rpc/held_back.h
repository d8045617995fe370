// SPDX-License-Identifier: Apache-2.0
// Whether a publisher is held back: while its last frame waits, none is received.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

namespace viewloom {

// A frame that would only replace one that waits is not received, since that costs and shows
// nothing. Where a turn is long in coming, as while kernels compile, frames are received all the
// same: else the one that waits, and those on their way behind it, grow old. Thread-safety: none.
class HeldBack {
 public:
  static constexpr int64_t kMost_ns = 1'000'000'000;

  // A frame waits from now on, and nothing older of its publisher.
  void noteOffered(uint64_t number, int64_t now_ns) {
    newest_ = number;
    if (!since_ns_) since_ns_ = now_ns;
  }
  // The frame waits no longer. How long its turn was in coming, counted from the first frame that
  // waited for it; empty = a newer frame has replaced it, and waits.
  std::optional<int64_t> noteTaken(uint64_t number, int64_t now_ns) {
    if (number != newest_ || !since_ns_) return std::nullopt;
    return now_ns - *std::exchange(since_ns_, std::nullopt);
  }

  // No frame is received now.
  bool holds(int64_t now_ns) const { return since_ns_ && now_ns - *since_ns_ < kMost_ns; }

 private:
  uint64_t newest_ = 0;              // number of the frame that waits
  std::optional<int64_t> since_ns_;  // since when a turn is waited for
};

}  // namespace viewloom
