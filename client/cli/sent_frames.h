// SPDX-License-Identifier: Apache-2.0
// Follow-up of frames that `viewloom publish` has sent: reports on their depth and colour, and a
// recording of them.
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "base/clock.h"
#include "base/status.h"
#include "cli/status_line.h"
#include "lib/compress_frame.h"
#include "recording/frame_recording.h"

namespace viewloom::cli {

// Thread-safety: record() comes first, and take() belongs to one thread; the others may be called
// from any thread.
class SentFrames {
 public:
  // Line and clock must outlive it.
  SentFrames(StatusLine& line, const Clock& clock) : line_(line), clock_(clock) {}

  // From now on frames are kept. INVALID_ARGUMENT when the file cannot be written.
  absl::Status record(const std::string& file);
  void take(const CompressedFrame& frame);
  // Why frames are kept no longer; OK while they are.
  absl::Status failure() const;
  // The coarsest of the newest frame, 1/m; 0 = depth goes as it is.
  double depthStep() const;
  // Ends the recording, if there is one, and says so. Fails when frames were kept no longer. What
  // is taken afterwards is not kept.
  absl::Status complete();

 private:
  void tellDepth(const std::vector<QuantisedDepth>& sources);
  void tellColor(const v1::FrameHeader& header);

  StatusLine& line_;
  const Clock& clock_;
  std::string file_;
  std::mutex recorder_mutex_;                // held while a frame is written; before mutex_
  std::unique_ptr<FrameRecorder> recorder_;  // null = none
  enum class Told { kNothing, kQuantised, kKept } told_ = Told::kNothing;
  bool has_told_color_ = false;
  mutable std::mutex mutex_;
  absl::Status failure_;
  double depth_step_ = 0;
};

}  // namespace viewloom::cli
