// SPDX-License-Identifier: Apache-2.0
#include "encode/video_encoders.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <utility>
#include <vector>

#include "base/idle_memory.h"
#include "display/video_stack.h"
#include "video/view_format.h"

namespace viewloom {
namespace {

constexpr size_t kKeptCount = 4;
// Rows of a slice at least: each predicts anew.
constexpr uint32_t kSliceRowsMin = 64;

using EncoderPtr = std::unique_ptr<VideoEncoder>;

uint64_t bytesOfEncoder(const VideoEncoder& encoder) {
  return videoEncoderBytes(encoder.format().size_px);
}

}  // namespace

struct VideoEncoders::Shelf final : IdleMemory {
  using Clock = std::chrono::steady_clock;

  struct Free {
    EncoderPtr encoder;
    Clock::time_point since;
  };

  mutable std::mutex mutex;   // guards what follows
  std::vector<Free> waiting;  // longest waiting first

  // nullptr = none waits.
  EncoderPtr take(const VideoFormat& format) {
    std::lock_guard lock(mutex);
    const auto found = std::ranges::find_if(
        waiting, [&](const Free& free) { return free.encoder->format() == format; });
    if (found == waiting.end()) return nullptr;
    EncoderPtr encoder = std::move(found->encoder);
    waiting.erase(found);
    return encoder;
  }

  void putBack(EncoderPtr encoder) {
    EncoderPtr oldest;  // let go after the lock
    std::lock_guard lock(mutex);
    waiting.push_back({std::move(encoder), Clock::now()});
    if (waiting.size() <= kKeptCount) return;
    oldest = std::move(waiting.front().encoder);
    waiting.erase(waiting.begin());
  }

  uint64_t idleBytes() const override {
    std::lock_guard lock(mutex);
    uint64_t bytes = 0;
    for (const Free& free : waiting) bytes += bytesOfEncoder(*free.encoder);
    return bytes;
  }

  uint64_t releaseIdle(std::chrono::nanoseconds unused_for) override {
    const Clock::time_point until = Clock::now() - unused_for;
    std::vector<Free> released;  // let go after the lock
    uint64_t bytes = 0;
    std::lock_guard lock(mutex);
    while (!waiting.empty() && waiting.front().since <= until) {
      bytes += bytesOfEncoder(*waiting.front().encoder);
      released.push_back(std::move(waiting.front()));
      waiting.erase(waiting.begin());
    }
    return bytes;
  }
};

VideoEncoders::VideoEncoders(uint32_t thread_count, VideoEncoderChoicePtr choice)
    : thread_count_(thread_count), choice_(std::move(choice)), shelf_(std::make_shared<Shelf>()) {}

VideoFormat VideoEncoders::formatOf(SizePx picture_px, uint32_t qp) const {
  const uint32_t slice_count_max = std::max(picture_px.height / kSliceRowsMin, 1U);
  VideoFormat format = viewFormat(picture_px, qp);
  if (qp >= kThreadedQpMin) format.thread_count = std::min(thread_count_, slice_count_max);
  return format;
}

absl::StatusOr<EncoderPtr> VideoEncoders::take(SizePx picture_px, uint32_t qp) {
  const VideoFormat format = formatOf(picture_px, qp);
  if (EncoderPtr waiting = shelf_->take(format)) return waiting;
  return choice_->make(format);
}

absl::StatusOr<bool> VideoEncoders::setQp(EncoderPtr& encoder, uint32_t qp) {
  const VideoFormat& now = encoder->format();
  if (now.thread_count == formatOf(now.size_px, qp).thread_count) {
    VIEWLOOM_RETURN_IF_ERROR(encoder->setQp(qp));
    return false;
  }
  absl::StatusOr<EncoderPtr> other = take(now.size_px, qp);
  VIEWLOOM_RETURN_IF_ERROR(other.status());
  putBack(std::exchange(encoder, *std::move(other)));
  return true;
}

void VideoEncoders::putBack(EncoderPtr encoder) {
  shelf_->putBack(std::move(encoder));
}

std::shared_ptr<IdleMemory> VideoEncoders::idleMemory() const {
  return shelf_;
}

}  // namespace viewloom
