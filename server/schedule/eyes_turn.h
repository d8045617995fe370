// SPDX-License-Identifier: Apache-2.0
// When tracked eyes, which go first within the share of their identity, let its other displays go.
#pragma once

#include <algorithm>
#include <cstdint>

namespace viewloom {

// The turn of tracked displays. While others of the same identity wait, those get a part of the
// work for every kEyesPerOther parts: so no display stands still, and answers to eyes take no more
// than a third longer. Work in any unit, as it was done. Thread-safety: none.
class EyesTurn {
 public:
  static constexpr int64_t kEyesPerOther = 3;

  // Whether the next part is of another display.
  bool isOver() const { return owed_ > 0; }
  // A part of an atlas was done. What is owed never exceeds it: who comes late has no claim to the
  // past.
  void note(bool is_of_eyes, int64_t work) {
    owed_ =
        is_of_eyes ? std::min(owed_ + work / kEyesPerOther, work) : std::max(owed_ - work, -work);
  }

 private:
  int64_t owed_ = 0;  // to others
};

}  // namespace viewloom
