// SPDX-License-Identifier: Apache-2.0
// Destination of decoded frames, which reports one outcome for each frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/payer.h"
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
  std::string note{};  // for a person; usually empty
};

// Origin of a frame.
struct FrameOrigin {
  std::string stream;
  // Session of the publisher. With another session, everything learnt from the stream starts again.
  uint64_t session = 0;
  Payer publisher = {};  // who pays for what is built of it
};

// Called exactly once for each frame, from any thread; must not block.
using ReportFrame = std::function<void(const FrameReport&)>;

// Takes frames. Thread-safety: all methods may be called from any thread; none blocks.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  // Takes the newest frame of a stream. An older one that still waits is reported as kReplaced.
  virtual void offerFrame(const FrameOrigin& origin, FramePtr frame, ReportFrame report) = 0;
  // A frame of the stream waits to be decoded. True: it is to be decoded now, then it is offered or
  // lost. False: it waits on, and the sink knows of it.
  virtual bool wantsFrame(const std::string&) { return true; }
  // Frames of these streams wait, the oldest first. The place of the one whose turn it is, if it is
  // wanted.
  virtual size_t nextToDecode(const std::vector<FrameOrigin>&) { return 0; }
  // The decoding of a frame took so much CPU time, whether it succeeds or not.
  virtual void noteDecoded(const FrameOrigin&, int64_t) {}
  // `then` is called on any thread when the waiting frame of a stream may be wanted now, which it
  // was not before. Set once, before frames come.
  virtual void onWanted(std::function<void(const std::string& stream)>) {}
  // A wanted frame of the stream does not decode, and is not offered.
  virtual void noteLost(const std::string&) {}
  // Drops the structure of a stream whose name is free and that nobody watches.
  virtual void forgetStream(const std::string& stream) = 0;
};

}  // namespace viewloom
