// SPDX-License-Identifier: Apache-2.0
#include "video/video_encoder.h"

#include "base/str_cat.h"

namespace viewloom {

absl::Status checkVideoFormat(const VideoFormat& format, const PictureLimit& limit) {
  constexpr uint32_t kThreadsMax = 16;
  constexpr uint32_t kSlicesMax = 16;
  const SizePx size_px = format.size_px;
  const bool is_even = size_px.width % 2 == 0 && size_px.height % 2 == 0;
  if (!is_even || size_px.width < kVideoSideMin_px || size_px.height < kVideoSideMin_px ||
      !limit.holds(size_px)) {
    return absl::InvalidArgumentError(strCat("pictures of ", size_px.width, "x", size_px.height,
                                             " px; accepted are even sides of at least ",
                                             kVideoSideMin_px, " px, and up to ", limit.area_max_px,
                                             " px together"));
  }
  if (format.qp < kVideoQpMin || format.qp > kVideoQpMax) {
    return absl::InvalidArgumentError(
        strCat("quantisation ", format.qp, "; accepted is ", kVideoQpMin, " to ", kVideoQpMax));
  }
  if (format.thread_count < 1 || format.thread_count > kThreadsMax) {
    return absl::InvalidArgumentError(
        strCat(format.thread_count, " threads; accepted are 1 to ", kThreadsMax));
  }
  if (format.slice_count < 1 || format.slice_count > kSlicesMax) {
    return absl::InvalidArgumentError(
        strCat(format.slice_count, " slices; accepted are 1 to ", kSlicesMax));
  }
  return absl::OkStatus();
}

absl::Status checkPictureSize(const VideoPicture& picture, const VideoFormat& format) {
  if (picture.size_px == format.size_px) return absl::OkStatus();
  return absl::InvalidArgumentError(strCat("a picture of ", picture.size_px.width, "x",
                                           picture.size_px.height, " px for an encoder of ",
                                           format.size_px.width, "x", format.size_px.height));
}

}  // namespace viewloom
