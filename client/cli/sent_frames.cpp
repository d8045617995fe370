// SPDX-License-Identifier: Apache-2.0
#include "cli/sent_frames.h"

#include <algorithm>
#include <utility>

#include "base/str_cat.h"

namespace viewloom::cli {

absl::Status SentFrames::record(const std::string& file) {
  auto recorder = FrameRecorder::create(file, clock_);
  if (!recorder.ok()) return recorder.status();
  file_ = file;
  recorder_ = *std::move(recorder);
  return absl::OkStatus();
}

void SentFrames::take(const CompressedFrame& frame) {
  tellDepth(frame.depth);
  tellColor(frame.frame.header);
  std::lock_guard recording(recorder_mutex_);
  if (!recorder_ || !failure().ok()) return;
  absl::Status status = recorder_->add(frame.frame);
  std::lock_guard lock(mutex_);
  failure_ = std::move(status);
}

// Once, and again when it changes: steps differ a little from frame to frame.
void SentFrames::tellDepth(const std::vector<QuantisedDepth>& sources) {
  QuantisedDepth coarsest;
  for (const QuantisedDepth& source : sources) {
    const bool is_worse = coarsest.kept_because.empty() &&
                          (!source.kept_because.empty() || source.step > coarsest.step);
    if (is_worse) coarsest = source;
  }
  {
    std::lock_guard lock(mutex_);
    depth_step_ = coarsest.step;
  }
  if (!coarsest.kept_because.empty()) {
    if (std::exchange(told_, Told::kKept) == Told::kKept) return;
    line_.say(strCat("depth is sent unchanged, compressed without loss: ", coarsest.kept_because));
  } else if (coarsest.step > 0) {
    if (std::exchange(told_, Told::kQuantised) == Told::kQuantised) return;
    line_.say(strCat("depth is sent as 16-bit inverse depth in steps of ", coarsest.step,
                     " 1/m; steps up to ", coarsest.step_max,
                     " do not show (--depth-encoding plain "
                     "sends it unchanged)"));
  }
}

// Once: pictures of a feed seldom differ in size.
void SentFrames::tellColor(const v1::FrameHeader& header) {
  const auto is_video = [](const v1::Layer& layer) {
    return std::ranges::any_of(layer.planes(), [](const v1::Plane& plane) {
      return plane.encoding() == v1::PLANE_ENCODING_H264;
    });
  };
  const bool has_video = std::ranges::any_of(header.sources(), [&](const v1::Source& source) {
    return std::ranges::any_of(source.layers(), is_video);
  });
  if (!has_video || std::exchange(has_told_color_, true)) return;
  line_.say("colour is sent as video, with small errors (see --color-encoding)");
}

absl::Status SentFrames::failure() const {
  std::lock_guard lock(mutex_);
  return failure_;
}

double SentFrames::depthStep() const {
  std::lock_guard lock(mutex_);
  return depth_step_;
}

absl::Status SentFrames::complete() {
  std::lock_guard recording(recorder_mutex_);
  const std::unique_ptr<FrameRecorder> recorder = std::move(recorder_);
  if (!recorder) return absl::OkStatus();
  const absl::Status kept = failure();
  const absl::Status completed = recorder->complete();
  if (!completed.ok()) return kept.ok() ? completed : kept;
  const uint64_t count = recorder->frameCount();
  line_.say(strCat(file_, ": ", count, count == 1 ? " frame recorded" : " frames recorded"));
  return kept;
}

}  // namespace viewloom::cli
