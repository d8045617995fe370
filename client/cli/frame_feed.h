// SPDX-License-Identifier: Apache-2.0
// Where `viewloom publish` takes frames from, and when the next one is due.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.h"
#include "base/status.h"
#include "lib/wire_frame.h"

namespace viewloom::cli {

// Thread-safety: none; one owner.
class FrameFeed {
 public:
  virtual ~FrameFeed() = default;
  // The frame that is due elapsed_s after the first; nothing when there is none, yet or at all.
  virtual absl::StatusOr<std::optional<WireFrame>> next(double elapsed_s) = 0;
  // When the next frame is due, in seconds since the first, if frames bring their times along;
  // nothing = at the rate asked for.
  virtual std::optional<double> nextDue_s() { return std::nullopt; }
  // Whether there will be none any more, once there was none.
  virtual bool hasEnded() const { return true; }
  // Name of the published content, for the status: "synthetic 960x540, 2 layers".
  virtual std::string description() const = 0;
  // Notes about the frames since the last call, a line each.
  virtual std::vector<std::string> takeNotes() { return {}; }
  // The same, waiting for what is still being looked at: for the end.
  virtual std::vector<std::string> takeLastNotes() { return takeNotes(); }
  // A live feed goes on whether its frames are sent or not; others wait for each to be sent.
  virtual bool isLive() const = 0;
};

// Nanoseconds since 1970: a time that watchers on the same machine can compare.
int64_t captureTimeNs();

// When the next frame is due: by a rate, or by times that the frames bring along.
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
