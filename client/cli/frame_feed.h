// SPDX-License-Identifier: Apache-2.0
// Where `viewloom publish` takes frames from.
#pragma once

#include <optional>
#include <string>
#include <vector>

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
  // What is being published, for the status: "synthetic 960x540, 2 layers".
  virtual std::string description() const = 0;
  // What there is to say about the frames since the last call, a line each.
  virtual std::vector<std::string> takeNotes() { return {}; }
  // The same, waiting for what is still being looked at: for the end.
  virtual std::vector<std::string> takeLastNotes() { return takeNotes(); }
  // A live feed goes on whether its frames are sent or not; others wait for each to be sent.
  virtual bool isLive() const = 0;
};

// Nanoseconds since 1970: a time that watchers on the same machine can compare.
int64_t captureTimeNs();

}  // namespace viewloom::cli
