// SPDX-License-Identifier: Apache-2.0
#include "encode/video_encoders.h"

#include <algorithm>
#include <utility>

#include "video/openh264_encoder.h"

namespace viewloom {
namespace {

// An encoder holds about 10 bytes for each pixel of a picture.
constexpr size_t kKeptCount = 4;
// Rows of a slice at least: each predicts anew.
constexpr uint32_t kSliceRowsMin = 64;

}  // namespace

absl::StatusOr<std::unique_ptr<VideoEncoder>> VideoEncoders::take(SizePx picture_px, uint32_t qp) {
  const uint32_t slice_count_max = std::max(picture_px.height / kSliceRowsMin, 1U);
  const VideoFormat format = {
      .size_px = picture_px, .qp = qp, .thread_count = std::min(thread_count_, slice_count_max)};
  {
    std::lock_guard lock(mutex_);
    const auto found = std::ranges::find_if(
        free_, [&](const auto& encoder) { return encoder->format() == format; });
    if (found != free_.end()) {
      std::unique_ptr<VideoEncoder> encoder = std::move(*found);
      free_.erase(found);
      return encoder;
    }
  }
  auto made = OpenH264Encoder::make(format);
  VIEWLOOM_RETURN_IF_ERROR(made.status());
  return std::unique_ptr<VideoEncoder>(*std::move(made));
}

void VideoEncoders::putBack(std::unique_ptr<VideoEncoder> encoder) {
  std::unique_ptr<VideoEncoder> oldest;  // let go after the lock
  std::lock_guard lock(mutex_);
  free_.push_back(std::move(encoder));
  if (free_.size() <= kKeptCount) return;
  oldest = std::move(free_.front());
  free_.erase(free_.begin());
}

}  // namespace viewloom
