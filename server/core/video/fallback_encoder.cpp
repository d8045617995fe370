// SPDX-License-Identifier: Apache-2.0
#include "video/fallback_encoder.h"

#include <utility>

namespace viewloom {

FallbackEncoder::FallbackEncoder(std::unique_ptr<VideoEncoder> first, MakeVideoEncoder make_other,
                                 std::function<void(const absl::Status& failure)> on_failure)
    : encoder_(std::move(first)),
      make_other_(std::move(make_other)),
      on_failure_(std::move(on_failure)) {}

bool FallbackEncoder::isReplaceable(const absl::Status& result) const {
  return !result.ok() && !absl::IsInvalidArgument(result) && make_other_;
}

absl::Status FallbackEncoder::replace(const VideoFormat& format, const absl::Status& failure) {
  on_failure_(failure);
  auto other = std::exchange(make_other_, nullptr)(format);
  if (!other.ok()) return failure;
  encoder_ = *std::move(other);
  return absl::OkStatus();
}

absl::Status FallbackEncoder::setQp(uint32_t qp) {
  VideoFormat wanted = format();
  wanted.qp = qp;
  const absl::Status set = encoder_->setQp(qp);
  return isReplaceable(set) ? replace(wanted, set) : set;
}

absl::Status FallbackEncoder::encode(const VideoPicture& picture, Reference reference,
                                     std::vector<uint8_t>& access_unit) {
  const absl::Status coded = encoder_->encode(picture, reference, access_unit);
  if (!isReplaceable(coded)) return coded;
  VIEWLOOM_RETURN_IF_ERROR(replace(VideoFormat(format()), coded));
  return encoder_->encode(picture, Reference::kNone, access_unit);
}

}  // namespace viewloom
