// SPDX-License-Identifier: Apache-2.0
// Which of two atlases on their way goes first: eyes that move wait for nobody, but leave others
// their share.
#pragma once

#include <algorithm>
#include <cstdint>

#include "pipeline/atlas_run.h"

namespace viewloom {

// By how much tracked displays are due before their time: so long others may be overdue until they
// begin before them.
inline constexpr int64_t kEyesAhead_ns = 1'000'000'000;

// Of two that have begun, strip by strip or piece by piece: the sooner, of tracked displays before
// all others, however long those are overdue.
inline bool goesFirst(const AtlasRun& a, const AtlasRun& b) {
  if (a.isTracked() != b.isTracked()) return a.isTracked();
  return a.job.deadline_ns < b.job.deadline_ns;
}

// While others wait, they get a quarter of the work, however fast poses come: so answers to eyes
// take no more than a third longer, and no display stands still. Work in any unit, as it was done.
// Thread-safety: none.
class EyesTurn {
 public:
  // Whether the next part is of another atlas.
  bool isOver() const { return owed_ > 0; }
  // A part of an atlas. What is owed never exceeds it: who comes late has no claim to the past.
  void note(bool is_tracked, int64_t work) {
    owed_ =
        is_tracked ? std::min(owed_ + work / kEyesPerOther, work) : std::max(owed_ - work, -work);
  }

 private:
  static constexpr int64_t kEyesPerOther = 3;
  int64_t owed_ = 0;  // to others
};

}  // namespace viewloom
