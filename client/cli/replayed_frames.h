// SPDX-License-Identifier: Apache-2.0
// A recording of frames as a feed.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cli/frame_feed.h"
#include "recording/frame_recording.h"

namespace viewloom::cli {

struct ReplayOptions {
  std::string file;
  std::optional<double> rate_hz;  // evenly; nothing = as recorded
  double speed = 1;               // times as fast as recorded; without rate_hz
  bool is_looping = false;
};

// Every frame has the bytes it was recorded with. Its capture time is as far from that of the first
// as it was when recorded (by speed or rate), and the first was captured when it is taken.
class ReplayedFrames final : public FrameFeed {
 public:
  // Fails as FrameRecordingReader::open, and when there is no whole frame. now_ns: ns since 1970.
  static absl::StatusOr<std::unique_ptr<ReplayedFrames>> open(
      ReplayOptions options, std::function<int64_t()> now_ns = &captureTimeNs);

  absl::StatusOr<std::optional<WireFrame>> next(double elapsed_s) override;
  std::optional<double> nextDue_s() override;
  std::string description() const override;
  // Says that a recording is cut short, once its end has been met.
  std::vector<std::string> takeNotes() override;
  bool isLive() const override { return false; }

 private:
  ReplayedFrames(ReplayOptions options, std::function<int64_t()> now_ns,
                 std::unique_ptr<FrameRecordingReader> reader);

  void readAhead();
  void startAgain();
  // Playing time of a record, so long after the first frame.
  double playedAt_ns(double recorded_ns) const;
  int64_t captureTime(const RecordedFrame& frame);

  const ReplayOptions options_;
  const std::function<int64_t()> now_ns_;
  const std::unique_ptr<FrameRecordingReader> reader_;
  absl::StatusOr<std::optional<RecordedFrame>> ahead_;  // the next one
  uint64_t played_count_ = 0;
  uint64_t frame_count_ = 0;      // of the recording, as far as it has been read
  int64_t first_time_ns_ = 0;     // of the first frame
  int64_t last_time_ns_ = 0;      // of the newest frame read
  double earlier_rounds_ns_ = 0;  // of recorded time
  int64_t first_capture_ns_ = 0;  // in the recording
  int64_t started_ns_ = 0;        // by now_ns_
  bool is_repeating_ = false;
  std::vector<std::string> notes_;
};

}  // namespace viewloom::cli
