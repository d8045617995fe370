// SPDX-License-Identifier: Apache-2.0
// When the newest frame of a stream is built although no picture has asked for it.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

namespace viewloom {

// Without viewers, one frame is built in this time, for those who come and for lists of streams.
inline constexpr int64_t kUnwatched_ns = 1'000'000'000;
// But the first frames after a while are all built.
inline constexpr int64_t kUnwatchedBurst = 16;
// A picture asks for the newest frame when it is its turn. If none does, that frame is built after
// this time, for what is told of the stream. Turns come sooner, unless the server has far more to
// do than it can: then it must not build for nobody as well.
inline constexpr int64_t kHeldFrame_ns = 10'000'000'000;

// Displays that wait for the frames of a stream.
struct StreamDemand {
  bool is_watched = false;
  // One of them shows frames as they come, and asks for none: it has eyes or ticks of its own. If
  // it has eyes, it has begun with the resident frame.
  bool takes_all = false;
};

// One for each stream. Thread-safety: none.
class BuildGate {
 public:
  // When the next frame may be built unasked; empty = at once.
  std::optional<int64_t> waitUntilNs(const StreamDemand& demand, int64_t now_ns) const;
  // A frame was built, or is the resident one once more.
  void noteBuilt(const StreamDemand& demand, int64_t now_ns);

 private:
  std::optional<int64_t> built_ns_;  // the last one; empty = none was
  // From when on another frame may be built without viewers.
  int64_t unwatched_ns_ = std::numeric_limits<int64_t>::min();
};

}  // namespace viewloom
