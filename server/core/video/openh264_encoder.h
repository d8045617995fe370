// SPDX-License-Identifier: Apache-2.0
// H.264 encoder of the library OpenH264.
#pragma once

#include <memory>

#include "video/video_encoder.h"

class ISVCEncoder;

namespace viewloom {

// Codes at a fixed quantisation. Its parameter sets say the true level, the colour of
// shared/ycbcr.h, and that no picture is reordered.
class OpenH264Encoder final : public VideoEncoder {
 public:
  // INVALID_ARGUMENT for a format out of range, RESOURCE_EXHAUSTED if memory is missing.
  static absl::StatusOr<std::unique_ptr<OpenH264Encoder>> make(const VideoFormat& format);
  ~OpenH264Encoder() override;

  const VideoFormat& format() const override { return format_; }
  absl::Status setQp(uint32_t qp) override;
  absl::Status encode(const VideoPicture& picture, Reference reference,
                      std::vector<uint8_t>& access_unit) override;

 private:
  struct Destroy {
    void operator()(ISVCEncoder* encoder) const;
  };
  using EncoderPtr = std::unique_ptr<ISVCEncoder, Destroy>;

  OpenH264Encoder(const VideoFormat& format, EncoderPtr encoder);

  VideoFormat format_;
  const EncoderPtr encoder_;
  int64_t time_ms_ = 0;  // of the next picture; the library wants them to grow
};

}  // namespace viewloom
