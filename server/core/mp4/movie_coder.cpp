// SPDX-License-Identifier: Apache-2.0
#include "mp4/movie_coder.h"

#include <utility>

namespace viewloom {
namespace {

constexpr int64_t kSyncInterval_ns = 2'000'000'000;
// Bytes that OpenH264 holds for each pixel: its references, its copy of the picture, and its output
// (tests/performance.md).
constexpr uint64_t kEncoderBytesPerPx = 16;

}  // namespace

absl::StatusOr<std::unique_ptr<MovieCoder>> MovieCoder::make(const MovieCoding& coding) {
  auto encoder = coding.encoders->make(
      {.size_px = coding.video.picture_px, .qp = coding.qp, .thread_count = coding.thread_count});
  VIEWLOOM_RETURN_IF_ERROR(encoder.status());
  return std::unique_ptr<MovieCoder>(new MovieCoder(coding, *std::move(encoder)));
}

uint64_t MovieCoder::memoryBytes(const MovieCoding& coding) {
  return TiledPicture::memoryBytes(coding.atlas, coding.video) +
         kEncoderBytesPerPx * coding.video.picture_px.area();
}

MovieCoder::MovieCoder(const MovieCoding& coding, std::unique_ptr<VideoEncoder> encoder)
    : picture_(coding.atlas, coding.video), encoder_(std::move(encoder)) {}

absl::StatusOr<std::span<const uint8_t>> MovieCoder::code(const AtlasColors& colors,
                                                          int64_t time_ns) {
  newest_ = picture_.make(colors);
  return codeAgain(time_ns);
}

absl::StatusOr<std::span<const uint8_t>> MovieCoder::codeAgain(int64_t time_ns) {
  const bool is_sync = needs_sync_ || time_ns - sync_ns_ >= kSyncInterval_ns;
  const Reference reference = is_sync ? Reference::kNone : Reference::kPictureBefore;
  needs_sync_ = true;  // also after an error
  VIEWLOOM_RETURN_IF_ERROR(encoder_->encode(newest_, reference, access_unit_));
  needs_sync_ = false;
  if (is_sync) sync_ns_ = time_ns;
  return access_unit_;
}

}  // namespace viewloom
