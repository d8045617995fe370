// SPDX-License-Identifier: Apache-2.0
#include "pipeline/video_atlas.h"

#include <bit>
#include <utility>

#include "base/check.h"
#include "base/thread_time.h"

namespace viewloom {

VideoAtlas::VideoAtlas(const VideoStack& stack, uint32_t qp)
    : picture_px_(stack.pictureSize()),
      start_{.qp = qp},
      pictures_(stack.picture_count, {.planes = nullptr, .rows_left = picture_px_.height}) {}

std::shared_ptr<PicturePlanes> VideoAtlas::planesOf(uint32_t place, BytePool& pool) {
  std::lock_guard lock(mutex_);
  std::shared_ptr<PicturePlanes>& planes = pictures_[place].planes;
  if (!planes) planes = std::make_shared<PicturePlanes>(picture_px_, pool);
  return planes;
}

bool VideoAtlas::isNextReady() const {
  return next_ < pictures_.size() && pictures_[next_].rows_left == 0;
}

bool VideoAtlas::put(uint32_t place, const BandPixels& rows, BytePool& pool) {
  planesOf(place, pool)->put(rows);
  std::lock_guard lock(mutex_);
  VIEWLOOM_CHECK(pictures_[place].rows_left >= rows.row_count);
  pictures_[place].rows_left -= rows.row_count;
  if (is_coding_ || !isNextReady()) return false;
  is_coding_ = true;
  return true;
}

// Encoders that have just been taken may have coded another display before.
absl::StatusOr<Reference> VideoAtlas::prepare(std::unique_ptr<VideoEncoder>& encoder,
                                              uint32_t place, VideoEncoders& encoders) {
  bool is_new = !encoder;
  if (is_new) {
    absl::StatusOr<std::unique_ptr<VideoEncoder>> taken = encoders.take(picture_px_, start_.qp);
    VIEWLOOM_RETURN_IF_ERROR(taken.status());
    encoder = *std::move(taken);
  } else {
    const absl::StatusOr<bool> is_other = encoders.setQp(encoder, start_.qp);
    VIEWLOOM_RETURN_IF_ERROR(is_other.status());
    is_new = *is_other;
  }
  const bool refers = !is_new && (place != 0 || (start_.chain && !start_.is_self_contained));
  return refers ? Reference::kPictureBefore : Reference::kNone;
}

absl::StatusOr<CodedPicture> VideoAtlas::codeNext(VideoEncoders& encoders, BytePool& bytes) {
  std::shared_ptr<PicturePlanes> planes;
  CodedPicture coded;
  {
    std::lock_guard lock(mutex_);
    VIEWLOOM_CHECK(is_coding_ && isNextReady());
    coded.place = next_;
    planes = std::move(pictures_[next_].planes);
  }
  std::unique_ptr<VideoEncoder>& encoder = slot();
  const absl::StatusOr<Reference> reference = prepare(encoder, coded.place, encoders);
  VIEWLOOM_RETURN_IF_ERROR(reference.status());
  const int64_t begun_ns = wallTimeNs();
  const absl::Status status = encoder->encode(planes->video(), *reference, access_unit_);
  if (!status.ok()) {
    encoder = nullptr;  // also of a chain: the next atlas begins with another
    return status;
  }
  const int64_t taken_ns = wallTimeNs() - begun_ns;
  coded.help_ns = (encoder->format().thread_count - 1) * taken_ns;
  coding_ns_ += taken_ns + coded.help_ns;
  planes = nullptr;
  // Sizes vary from frame to frame; powers of two let the pool's buffers settle after a few.
  BytePool::Buffer unit = bytes.take(std::bit_ceil(access_unit_.size()));
  unit->assign(access_unit_.begin(), access_unit_.end());
  coded.bytes = std::move(unit);
  if (encoder_ && coded.place + 1 == pictures_.size()) encoders.putBack(std::move(encoder_));
  std::lock_guard lock(mutex_);
  ++next_;
  is_coding_ = coded.is_next_ready = isNextReady();
  return coded;
}

}  // namespace viewloom
