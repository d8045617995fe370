// SPDX-License-Identifier: Apache-2.0
// The atlases that are being traced, and whose turn it is at the device.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/turns.h"

namespace viewloom {

// Thread-safety: none; the picture loop's.
class BegunRuns {
 public:
  void add(AtlasRunPtr run) { runs_.push_back(std::move(run)); }
  void remove(const AtlasRun& run);
  // Lets go of them, and of what their making holds.
  void clear();
  bool isEmpty() const { return runs_.empty(); }

  bool hasTracked() const;
  // What goes first on a device; nullptr = nothing has begun.
  AtlasRunPtr soonest() const;
  // Of those that would have to wait for the first, the one whose turn it is, if it is that.
  AtlasRunPtr inTurn(const AtlasRun& first) const;
  // One that parts have been made of and holds memory, if there is one.
  AtlasRunPtr inSlot() const;
  // A part of it was submitted.
  void note(AtlasRun& run, uint64_t ray_count);

 private:
  std::vector<AtlasRunPtr> runs_;
  EyesTurn eyes_turn_;    // in rays
  ShortTurn short_turn_;  // the same, of those that are not tracked
};

}  // namespace viewloom
