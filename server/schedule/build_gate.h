// SPDX-License-Identifier: Apache-2.0
// When the newest frame of a stream is built, so that no structure is made that nobody traces.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

namespace viewloom {

// Without viewers, one frame is built in this time, for those who come and for lists of streams.
inline constexpr int64_t kUnwatched_ns = 1'000'000'000;
// But the first frames after a while are all built.
inline constexpr int64_t kUnwatchedBurst = 16;
// While all pictures of a stream wait to begin with the frame that is resident, a newer one waits,
// and may be replaced: of those that are built meanwhile only the last would be shown. Once one of
// the pictures could begin, it asks for the newest frame. If none does, the frame is built after
// this time.
inline constexpr int64_t kHeldFrame_ns = 1'000'000'000;

// Displays that wait for the frames of a stream.
struct StreamDemand {
  bool is_watched = false;
  bool all_wait = false;  // every picture waits to begin, and has waited for the resident frame
  bool is_asked = false;  // one of them could begin with a newer frame
};

// One for each stream. Thread-safety: none.
class BuildGate {
 public:
  // When the next frame may be built; empty = at once.
  std::optional<int64_t> waitUntilNs(const StreamDemand& demand, int64_t now_ns) const;
  // A frame is resident from now on.
  void noteBuilt(const StreamDemand& demand, int64_t now_ns);

 private:
  std::optional<int64_t> built_ns_;  // the last one; empty = none was
  // From when on another frame may be built without viewers.
  int64_t unwatched_ns_ = std::numeric_limits<int64_t>::min();
};

}  // namespace viewloom
