// SPDX-License-Identifier: Apache-2.0
// When the next frame is due: by a rate, or by times that the frames bring along.
#pragma once

#include <cstdint>
#include <optional>

#include "base/clock.h"

namespace viewloom::cli {

// Thread-safety: none.
class FramePace {
 public:
  // Starts with the first frame: now. The clock must outlive the pace. rate_hz > 0
  FramePace(const Clock& clock, double rate_hz);

  // Seconds from the first frame to the next. `own_s` is the frame's own time, if it has one; by
  // the rate, a late frame is left out rather than all that follow being late.
  double nextDue_s(std::optional<double> own_s);
  // How long until then; not more than 0 when it is due.
  int64_t left_ns(double due_s) const;

 private:
  double elapsed_s() const;

  const Clock& clock_;
  const int64_t start_ns_;
  const double rate_hz_;
  double due_index_ = 0;
};

}  // namespace viewloom::cli
