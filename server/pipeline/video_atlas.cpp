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

std::shared_ptr<PicturePlanes> VideoAtlas::planesOf(uint32_t picture, BytePool& pool) {
  std::lock_guard lock(mutex_);
  std::shared_ptr<PicturePlanes>& planes = pictures_[picture].planes;
  if (!planes) planes = std::make_shared<PicturePlanes>(picture_px_, pool);
  return planes;
}

bool VideoAtlas::isNextReady() const {
  return next_ < pictures_.size() && pictures_[next_].rows_left == 0;
}

bool VideoAtlas::put(uint32_t picture, const BandPixels& rows, BytePool& pool) {
  planesOf(picture, pool)->put(rows);
  std::lock_guard lock(mutex_);
  VIEWLOOM_CHECK(pictures_[picture].rows_left >= rows.row_count);
  pictures_[picture].rows_left -= rows.row_count;
  if (is_coding_ || !isNextReady()) return false;
  is_coding_ = true;
  return true;
}

absl::StatusOr<VideoEncoder*> VideoAtlas::encoderOf(uint32_t picture, VideoEncoders& encoders) {
  if (start_.chain) start_.chain->encoders.resize(pictures_.size());
  std::unique_ptr<VideoEncoder>& encoder =
      start_.chain ? start_.chain->encoders[picture] : encoder_;
  if (!encoder) {
    absl::StatusOr<std::unique_ptr<VideoEncoder>> taken = encoders.take(picture_px_, start_.qp);
    VIEWLOOM_RETURN_IF_ERROR(taken.status());
    encoder = *std::move(taken);
  }
  VIEWLOOM_RETURN_IF_ERROR(encoder->setQp(start_.qp));
  return encoder.get();
}

Reference VideoAtlas::referenceOf(uint32_t picture) const {
  const bool refers = start_.chain ? !start_.is_self_contained : picture != 0;
  return refers ? Reference::kPictureBefore : Reference::kNone;
}

absl::StatusOr<CodedPicture> VideoAtlas::codeNext(VideoEncoders& encoders, BytePool& bytes) {
  std::shared_ptr<PicturePlanes> planes;
  CodedPicture coded;
  {
    std::lock_guard lock(mutex_);
    VIEWLOOM_CHECK(is_coding_ && isNextReady());
    coded.picture = next_;
    planes = std::move(pictures_[next_].planes);
  }
  const absl::StatusOr<VideoEncoder*> encoder = encoderOf(coded.picture, encoders);
  VIEWLOOM_RETURN_IF_ERROR(encoder.status());
  const int64_t begun_ns = wallTimeNs();
  VIEWLOOM_RETURN_IF_ERROR(
      (*encoder)->encode(planes->video(), referenceOf(coded.picture), access_unit_));
  coded.help_ns = ((*encoder)->format().thread_count - 1) * (wallTimeNs() - begun_ns);
  planes = nullptr;
  // Sizes vary from frame to frame; powers of two let the pool's buffers settle after a few.
  BytePool::Buffer unit = bytes.take(std::bit_ceil(access_unit_.size()));
  unit->assign(access_unit_.begin(), access_unit_.end());
  coded.bytes = std::move(unit);
  if (encoder_ && coded.picture + 1 == pictures_.size()) encoders.putBack(std::move(encoder_));
  std::lock_guard lock(mutex_);
  ++next_;
  is_coding_ = coded.is_next_ready = isNextReady();
  return coded;
}

}  // namespace viewloom
