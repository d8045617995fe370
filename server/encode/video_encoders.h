// SPDX-License-Identifier: Apache-2.0
// Video encoders that wait for their next atlas.
#pragma once

#include <cstdint>
#include <memory>

#include "video/encoder_choice.h"

namespace viewloom {

class IdleMemory;

// To make an encoder takes memory and time, and one serves any atlas of its format.
// Thread-safety: all methods may be called from any thread.
class VideoEncoders {
 public:
  // `thread_count`: threads of each encoder, 1..16.
  explicit VideoEncoders(uint32_t thread_count,
                         VideoEncoderChoicePtr choice = VideoEncoderChoice::openH264());

  // An encoder of views (viewFormat) that nobody else has. Errors as of VideoEncoderChoice::make.
  absl::StatusOr<std::unique_ptr<VideoEncoder>> take(SizePx picture_px, uint32_t qp);
  // Quantisation of the pictures to come. Where it takes another number of threads, another encoder
  // takes the place of this one, whose first picture may refer to none: true. Errors as of take(),
  // and of VideoEncoder::setQp.
  absl::StatusOr<bool> setQp(std::unique_ptr<VideoEncoder>& encoder, uint32_t qp);
  // Keeps the newest few.
  void putBack(std::unique_ptr<VideoEncoder> encoder);

  // The encoders that wait.
  std::shared_ptr<IdleMemory> idleMemory() const;

 private:
  struct Shelf;

  VideoFormat formatOf(SizePx picture_px, uint32_t qp) const;

  const uint32_t thread_count_;
  const VideoEncoderChoicePtr choice_;
  const std::shared_ptr<Shelf> shelf_;
};

}  // namespace viewloom
