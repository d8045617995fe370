// SPDX-License-Identifier: Apache-2.0
// Interface of video decoders.
#pragma once

#include <cstdint>
#include <span>

#include "base/status.h"
#include "frame/size.h"
#include "video/video_picture.h"

namespace viewloom {

// Pictures that a stream may make its decoder keep, by its sequence parameter set.
inline constexpr uint32_t kVideoReferencesMax = 4;

// Decodes H.264, one picture a call. Thread-safety: none; one thread at a time.
class VideoDecoder {
 public:
  virtual ~VideoDecoder() = default;

  // `access_unit`: one whole picture in Annex B format, of any bytes. The result is valid until the
  // next call. INVALID_ARGUMENT if the bytes are no picture or several, are damaged, refer to a
  // picture that is missing, or show a picture of another size than `size_px`; also for a stream
  // that keeps more than kVideoReferencesMax pictures. After an error all pictures are refused
  // until one comes that needs no other.
  virtual absl::StatusOr<VideoPicture> decode(std::span<const uint8_t> access_unit,
                                              SizePx size_px) = 0;
};

}  // namespace viewloom
