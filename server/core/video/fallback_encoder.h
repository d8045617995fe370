// SPDX-License-Identifier: Apache-2.0
// An encoder that goes on with another one when it fails.
#pragma once

#include <functional>
#include <memory>

#include "video/encoder_kind.h"

namespace viewloom {

class FallbackEncoder final : public VideoEncoder {
 public:
  // `make_other` is called once, after `first` has failed and on_failure was told of it.
  FallbackEncoder(std::unique_ptr<VideoEncoder> first, MakeVideoEncoder make_other,
                  std::function<void(const absl::Status& failure)> on_failure);

  const VideoFormat& format() const override { return encoder_->format(); }
  // Where the first encoder fails, the other one begins with this quantisation.
  absl::Status setQp(uint32_t qp) override;
  // The picture at which the first encoder fails becomes an IDR picture of the other one, so
  // readers decode on. Errors as of the other encoder, or of the first if there is no other for
  // such pictures.
  absl::Status encode(const VideoPicture& picture, Reference reference,
                      std::vector<uint8_t>& access_unit) override;

 private:
  // Whether another encoder may go on after such a result.
  bool isReplaceable(const absl::Status& result) const;
  // `failure` if there is no other for this format.
  absl::Status replace(const VideoFormat& format, const absl::Status& failure);

  std::unique_ptr<VideoEncoder> encoder_;
  MakeVideoEncoder make_other_;  // empty once it was called
  const std::function<void(const absl::Status& failure)> on_failure_;
};

}  // namespace viewloom
