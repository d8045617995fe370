// SPDX-License-Identifier: Apache-2.0
// Which of two atlases on their way goes first: eyes that move wait for nobody, and atlases of many
// rays let others by, but all of them leave others their share.
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

// The same on a device, where an atlas may be long: until another has had as much, that goes first.
inline bool goesFirstOnDevice(const AtlasRun& a, const AtlasRun& b) {
  if (a.isLong() != b.isLong()) return b.isLong();
  return goesFirst(a, b);
}

// The same at the worker threads.
inline bool goesFirstAtWork(const AtlasRun& a, const AtlasRun& b) {
  if (a.isLongWork() != b.isLongWork()) return b.isLongWork();
  return goesFirst(a, b);
}

// The turn of those who go first. While others wait, they get a part of the work for every
// kFirstPerOther parts: so no display stands still. Work in any unit, as it was done.
// Thread-safety: none.
template <int64_t kFirstPerOther>
class Turn {
 public:
  // Whether the next part is of another atlas.
  bool isOver() const { return owed_ > 0; }
  // A part of an atlas. What is owed never exceeds it: who comes late has no claim to the past.
  void note(bool goes_first, int64_t work) {
    owed_ =
        goes_first ? std::min(owed_ + work / kFirstPerOther, work) : std::max(owed_ - work, -work);
  }

 private:
  int64_t owed_ = 0;  // to others
};

// A quarter of the work is left to others, however fast poses come: so answers to eyes take no more
// than a third longer.
using EyesTurn = Turn<3>;
// Long atlases and all others share the work alike.
using ShortTurn = Turn<1>;

}  // namespace viewloom
