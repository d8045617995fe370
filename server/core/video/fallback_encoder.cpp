// SPDX-License-Identifier: Apache-2.0
#include "video/fallback_encoder.h"

#include <utility>

namespace viewloom {

FallbackEncoder::FallbackEncoder(std::unique_ptr<VideoEncoder> first, MakeVideoEncoder make_other,
                                 std::function<void(const absl::Status& failure)> on_failure)
    : encoder_(std::move(first)),
      make_other_(std::move(make_other)),
      on_failure_(std::move(on_failure)) {}

absl::Status FallbackEncoder::encode(const VideoPicture& picture, Reference reference,
                                     std::vector<uint8_t>& access_unit) {
  const absl::Status coded = encoder_->encode(picture, reference, access_unit);
  if (coded.ok() || absl::IsInvalidArgument(coded) || !make_other_) return coded;
  on_failure_(coded);
  auto other = std::exchange(make_other_, nullptr)(format());
  if (!other.ok()) return coded;
  encoder_ = *std::move(other);
  return encoder_->encode(picture, Reference::kNone, access_unit);
}

}  // namespace viewloom
