// SPDX-License-Identifier: Apache-2.0
// Times of pictures in a movie, from the times of the frames that they show.
#pragma once

#include <algorithm>
#include <cstdint>

#include "mp4/movie_boxes.h"

namespace viewloom {

// Ticks of a time in a movie. Expects 0 or more.
inline uint64_t movieTicks(int64_t time_ns) {
  constexpr uint64_t kNsPerSecond = 1'000'000'000;
  const auto since_ns = uint64_t(time_ns);
  return since_ns / kNsPerSecond * kMovieTicksPerSecond +
         since_ns % kNsPerSecond * kMovieTicksPerSecond / kNsPerSecond;
}

// Keeps the steps between frames, as long as pictures come about as fast. Where the times of frames
// jump, as those of another publisher do, the time of arrival counts. Thread-safety: none.
class MovieClock {
 public:
  // Time of the next picture, ns since the first one, at least 1 ms after the picture before.
  // `shown_ns`: the time that it shows, any clock. `arrived_ns`: when it came, a monotonic clock.
  int64_t next(int64_t shown_ns, int64_t arrived_ns) {
    if (!has_begun_) {
      has_begun_ = true;
      first_arrived_ns_ = arrived_ns;
      shown_zero_ns_ = last_shown_ns_ = shown_ns;
      return last_ns_ = 0;
    }
    const int64_t by_arrival_ns = arrived_ns - first_arrived_ns_;
    int64_t time_ns = difference(shown_ns, shown_zero_ns_);
    if (time_ns < by_arrival_ns - kTolerance_ns || time_ns > by_arrival_ns + kTolerance_ns) {
      shown_zero_ns_ = difference(shown_ns, by_arrival_ns);
      time_ns = by_arrival_ns;
    }
    // The same frame once more, such as after a change of the focal plane.
    if (shown_ns == last_shown_ns_) time_ns = by_arrival_ns;
    last_shown_ns_ = shown_ns;
    return last_ns_ = std::max(time_ns, last_ns_ + kStepMin_ns);
  }
  // End of the last picture, if nothing comes any more.
  int64_t end(int64_t now_ns) const {
    return std::max(now_ns - first_arrived_ns_, last_ns_ + kStepMin_ns);
  }

 private:
  static constexpr int64_t kTolerance_ns = 500'000'000;
  static constexpr int64_t kStepMin_ns = 1'000'000;

  // Clocks of others may say anything: the difference may wrap.
  static int64_t difference(int64_t a, int64_t b) { return int64_t(uint64_t(a) - uint64_t(b)); }

  bool has_begun_ = false;
  int64_t first_arrived_ns_ = 0;
  int64_t shown_zero_ns_ = 0;  // time that is shown at 0
  int64_t last_shown_ns_ = 0;
  int64_t last_ns_ = 0;
};

}  // namespace viewloom
