// SPDX-License-Identifier: Apache-2.0
// Rung of a display's video that one reader belongs to.
#pragma once

#include <cstdint>
#include <limits>

#include "base/spell.h"
#include "base/video_rung.h"
#include "publish/line_fit.h"

namespace viewloom {

// Waits before a reader changes its rung, so that it does not go to and fro. It leaves the first
// rung once its line has been far too slow for so long that no finer step on trial (QualityRung),
// and no short disturbance, is the reason. It comes back once its line has had room for as long; a
// return that was in vain makes the next one later.
// Times are monotonic. Thread-safety: none.
class ReaderRung {
 public:
  VideoRung rung() const { return rung_; }

  // To be called a few times a second: how the first rung suits the line. True: the reader is to
  // move to the other rung. It is said once; if nothing comes of it, all waits begin anew.
  bool wantsOther(LineFit first, int64_t now_ns);
  // It has moved there.
  void noteMoved(int64_t now_ns);

 private:
  static constexpr int64_t kNever_ns = std::numeric_limits<int64_t>::min();
  // A finer step is on trial for 2 s, and the speed of a line is that of the last second.
  static constexpr int64_t kWait_ns = 3'000'000'000;

  void restartSpells();

  VideoRung rung_ = VideoRung::kFirst;
  Spell far_;
  Spell fits_;
  Spell shows_no_limit_;
  int64_t returned_ns_ = kNever_ns;  // to the first rung
  int64_t return_wait_ns_ = kWait_ns;
};

}  // namespace viewloom
