// SPDX-License-Identifier: Apache-2.0
// Streams of which a frame waits to be decoded.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "frame/frame_sink.h"

namespace viewloom {

// In the order in which they came. Thread-safety: none.
class StreamQueue {
 public:
  bool empty() const { return queue_.empty(); }
  void push(FrameOrigin origin) { queue_.push_back({.origin = std::move(origin)}); }
  // False: it is not here.
  bool drop(const std::string& stream);

  // The stream that the sink wants and whose turn it is leaves the queue; none = none is wanted.
  // The sink is not asked about a stream again before allow(): whoever takes a frame need not go
  // over all streams whose frames wait.
  std::optional<FrameOrigin> takeWanted(FrameSink& sink);
  // The sink may want the frame that it did not want. False: none of the stream waits.
  bool allow(const std::string& stream);
  // The stream whose turn it is leaves the queue, wanted or not; none = it is empty.
  std::optional<FrameOrigin> takeNext(FrameSink& sink);

 private:
  struct Entry {
    FrameOrigin origin;
    bool is_unwanted = false;  // as the sink has said
  };

  std::deque<Entry>::iterator find(const std::string& stream);

  std::deque<Entry> queue_;
};

}  // namespace viewloom
