// SPDX-License-Identifier: Apache-2.0
// Speed at which one reader's connection takes atlases.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace viewloom {

// Measures what the socket takes: a write that has to wait for room in it tells the speed of the
// line. Unsent bytes are limited (base/send_queue.h), so that this shows within tenths of a second.
// Times are monotonic, and may not go back. Thread-safety: none.
class ReaderLink {
 public:
  // Bytes go to the socket, and the socket has taken them. One write at a time.
  void beginWrite(uint64_t bytes, int64_t now_ns);
  void endWrite(int64_t now_ns);
  // All that was written since the last such call was one atlas. Ends the write under way.
  void endAtlas(int64_t now_ns);

  // Bytes a second. None = nothing shows a limit: the socket was seldom busy in the last second.
  std::optional<double> bytesPerSecond(int64_t now_ns) const;
  // Bytes that went out, or are going, in the last second.
  uint64_t recentBytes(int64_t now_ns) const;
  bool isWriting() const { return write_begun_ns_ != kIdle; }

 private:
  static constexpr int64_t kIdle = INT64_MIN;

  struct Delivery {
    uint64_t bytes = 0;
    int64_t busy_ns = 0;  // of the socket, with it
    int64_t done_ns = 0;
  };

  // The atlas that is being written, as far as it is out.
  Delivery current(int64_t now_ns) const;
  Delivery recent(int64_t now_ns) const;

  std::deque<Delivery> deliveries_;  // oldest first, bounded
  Delivery current_;                 // without the write under way
  uint64_t write_bytes_ = 0;
  int64_t write_begun_ns_ = kIdle;
};

}  // namespace viewloom
