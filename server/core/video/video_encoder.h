// SPDX-License-Identifier: Apache-2.0
// Interface of video encoders.
#pragma once

#include <cstdint>
#include <vector>

#include "base/status.h"
#include "frame/size.h"
#include "video/picture_limit.h"
#include "video/quantisation.h"
#include "video/video_picture.h"

namespace viewloom {

// Coding of syntax elements as bits (9.2 and 9.3).
enum class EntropyCoding : uint8_t {
  kArithmetic,      // CABAC: a twelfth less bytes
  kVariableLength,  // CAVLC: decoders take half of the time
};

// Format of all pictures of an encoder.
struct VideoFormat {
  SizePx size_px;             // even, from 16x16 px to the limit of the encoder
  uint32_t qp = 26;           // quantisation, kVideoQpMin..kVideoQpMax
  uint32_t thread_count = 1;  // 1..16, each codes a slice of a picture; 1 = the caller's thread
  // A wish, 1..16: slices of a picture at least; decoders' threads share them.
  uint32_t slice_count = 1;
  EntropyCoding entropy = EntropyCoding::kArithmetic;  // a wish, too

  bool operator==(const VideoFormat&) const = default;
};

inline constexpr uint32_t kVideoSideMin_px = 16;

// INVALID_ARGUMENT for a format that an encoder with this limit does not take.
absl::Status checkVideoFormat(const VideoFormat& format, const PictureLimit& limit);
// INVALID_ARGUMENT for a picture of another size than the format's.
absl::Status checkPictureSize(const VideoPicture& picture, const VideoFormat& format);

// Picture that a coded picture refers to.
enum class Reference : uint8_t { kNone, kPictureBefore };

// Codes pictures as H.264. Each call makes one access unit in Annex B format. A picture without a
// reference is an IDR picture with its parameter sets; others are P pictures that refer to the
// picture of the last call alone. Pictures leave in the order in which they come.
// Thread-safety: none; one thread at a time.
class VideoEncoder {
 public:
  virtual ~VideoEncoder() = default;

  virtual const VideoFormat& format() const = 0;
  // Quantisation of the pictures to come, kVideoQpMin..51. They may refer to those before; an
  // encoder that has to begin anew for it codes the next one without a reference.
  // INVALID_ARGUMENT for one that make() would refuse, INTERNAL if the encoder fails.
  virtual absl::Status setQp(uint32_t qp) = 0;
  // Replaces the content of `access_unit`. The first picture has no reference, whatever is asked.
  // INVALID_ARGUMENT for a picture of another size, INTERNAL if the encoder fails.
  // RESOURCE_EXHAUSTED if memory is missing. After an error the next picture needs kNone.
  virtual absl::Status encode(const VideoPicture& picture, Reference reference,
                              std::vector<uint8_t>& access_unit) = 0;
};

}  // namespace viewloom
