// SPDX-License-Identifier: Apache-2.0
#include "cli/replayed_frames.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "absl/numeric/int128.h"
#include "base/str_cat.h"

namespace viewloom::cli {
namespace {

constexpr double kLoneFrame_ns = 1e9 / 15;  // how long a recording of one frame lasts
// Capture times farther apart than a century are no times; their sums would not fit.
constexpr double kCaptureSpanMax_ns = 3e18;

}  // namespace

ReplayedFrames::ReplayedFrames(ReplayOptions options, std::function<int64_t()> now_ns,
                               std::unique_ptr<FrameRecordingReader> reader)
    : options_(std::move(options)), now_ns_(std::move(now_ns)), reader_(std::move(reader)) {
  readAhead();
}

absl::StatusOr<std::unique_ptr<ReplayedFrames>> ReplayedFrames::open(
    ReplayOptions options, std::function<int64_t()> now_ns) {
  auto reader = FrameRecordingReader::open(options.file);
  if (!reader.ok()) return reader.status();
  std::unique_ptr<ReplayedFrames> frames(
      new ReplayedFrames(std::move(options), std::move(now_ns), *std::move(reader)));
  if (!frames->ahead_.ok()) return frames->ahead_.status();
  if (!frames->ahead_->has_value()) {
    return absl::InvalidArgumentError(
        strCat(frames->options_.file,
               ": contains no complete frame. Record it again with `viewloom publish --record`"));
  }
  return frames;
}

void ReplayedFrames::readAhead() {
  ahead_ = reader_->next();
  if (!ahead_.ok() || !ahead_->has_value()) return;
  last_time_ns_ = (*ahead_)->time_ns;
  if (frame_count_ == 0) first_time_ns_ = last_time_ns_;
  frame_count_ += !is_repeating_;
}

void ReplayedFrames::startAgain() {
  // The last frame lasts as long as those before it did on average.
  const double span_ns = static_cast<double>(last_time_ns_ - first_time_ns_);
  const double frames = static_cast<double>(frame_count_);
  earlier_rounds_ns_ += frame_count_ > 1 ? span_ns * frames / (frames - 1) : kLoneFrame_ns;
  is_repeating_ = true;
  reader_->rewind();
  readAhead();
}

double ReplayedFrames::playedAt_ns(double recorded_ns) const {
  return (earlier_rounds_ns_ + recorded_ns) / options_.speed;
}

int64_t ReplayedFrames::captureTime(const RecordedFrame& frame) {
  const int64_t recorded_ns = frame.frame.header.capture_time_ns();
  if (played_count_ == 0) {
    started_ns_ = now_ns_();
    first_capture_ns_ = recorded_ns;
  }
  // In more than 64 bits: recorded times are anybody's.
  const auto since_first_ns =
      static_cast<double>(absl::int128(recorded_ns) - absl::int128(first_capture_ns_));
  const double since_start_ns = options_.rate_hz
                                    ? 1e9 * static_cast<double>(played_count_) / *options_.rate_hz
                                    : playedAt_ns(since_first_ns);
  return started_ns_ +
         static_cast<int64_t>(std::clamp(since_start_ns, -kCaptureSpanMax_ns, kCaptureSpanMax_ns));
}

absl::StatusOr<std::optional<WireFrame>> ReplayedFrames::next(double /*elapsed_s*/) {
  if (!ahead_.ok()) return ahead_.status();
  if (!ahead_->has_value()) return std::optional<WireFrame>();
  RecordedFrame frame = **std::move(ahead_);
  frame.frame.header.set_capture_time_ns(captureTime(frame));
  ++played_count_;
  readAhead();
  const bool is_at_end = ahead_.ok() && !ahead_->has_value();
  if (is_at_end && reader_->isCutShort() && !is_repeating_) {
    notes_.push_back(strCat(options_.file, ": ends before it is complete; replayed ", frame_count_,
                            frame_count_ == 1 ? " complete frame" : " complete frames"));
  }
  if (is_at_end && options_.is_looping) startAgain();
  return std::optional<WireFrame>(std::move(frame.frame));
}

std::optional<double> ReplayedFrames::nextDue_s() {
  if (options_.rate_hz || !ahead_.ok() || !ahead_->has_value()) return std::nullopt;
  return 1e-9 * playedAt_ns(static_cast<double>((*ahead_)->time_ns - first_time_ns_));
}

std::string ReplayedFrames::description() const {
  return strCat("recording ", std::filesystem::path(options_.file).filename().string());
}

std::vector<std::string> ReplayedFrames::takeNotes() {
  return std::exchange(notes_, {});
}

}  // namespace viewloom::cli
