// SPDX-License-Identifier: Apache-2.0
// Where decoded frames go, and what comes back: one outcome per frame.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "frame/frame.h"
#include "frame/stage_times.h"

namespace viewloom {

enum class FrameOutcome : uint8_t {
  kTraced,
  kBuiltWithoutDisplay,
  kReplaced,
  kRefused,
  kUnchanged
};

struct DisplayReport {
  uint64_t display_id = 0;
  Coverage coverage;
  StageTimes times;
};

struct FrameReport {
  uint64_t number = 0;
  FrameOutcome outcome = FrameOutcome::kReplaced;
  std::string reason{};  // kRefused
  std::vector<DisplayReport> displays{};
  SourceStats stats{};
  std::string note{};  // for a person; mostly empty
};

// Where a frame comes from.
struct FrameOrigin {
  std::string stream;
  // Of the publisher; with another one, whatever was learnt from the stream's frames starts anew.
  uint64_t session = 0;
};

// Called exactly once per frame, from any thread; must not block.
using ReportFrame = std::function<void(const FrameReport&)>;

// Thread-safety: all methods may be called from any thread; none blocks.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  // Takes the newest frame of a stream; an older one that still waits is reported kReplaced.
  virtual void offerFrame(const FrameOrigin& origin, FramePtr frame, ReportFrame report) = 0;
  // The stream's name is free again and nobody watches: its resident structure may go.
  virtual void forgetStream(const std::string& stream) = 0;
};

}  // namespace viewloom
