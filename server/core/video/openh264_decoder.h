// SPDX-License-Identifier: Apache-2.0
// H.264 decoder of the library OpenH264.
#pragma once

#include <memory>

#include "video/video_decoder.h"

class ISVCDecoder;

namespace viewloom {

// Never conceals damage: a picture is right, or refused. Sizes are checked before memory is taken.
// After an error the library begins anew, so that nothing of the refused bytes is left in it.
class OpenH264Decoder final : public VideoDecoder {
 public:
  // RESOURCE_EXHAUSTED if memory is missing.
  static absl::StatusOr<std::unique_ptr<OpenH264Decoder>> make();
  ~OpenH264Decoder() override;

  absl::StatusOr<VideoPicture> decode(std::span<const uint8_t> access_unit,
                                      SizePx size_px) override;

 private:
  struct Destroy {
    void operator()(ISVCDecoder* decoder) const;
  };
  using DecoderPtr = std::unique_ptr<ISVCDecoder, Destroy>;

  explicit OpenH264Decoder(DecoderPtr decoder);
  absl::Status start();
  void restart();
  absl::Status check(std::span<const uint8_t> access_unit, SizePx size_px) const;
  absl::StatusOr<VideoPicture> decodeChecked(std::span<const uint8_t> access_unit, SizePx size_px);

  const DecoderPtr decoder_;
  bool is_started_ = true;
  bool needs_idr_ = true;
};

}  // namespace viewloom
