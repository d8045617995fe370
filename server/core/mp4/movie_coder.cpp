// SPDX-License-Identifier: Apache-2.0
#include "mp4/movie_coder.h"

#include <utility>

#include "base/log.h"
#include "base/str_cat.h"
#include "video/openh264_kind.h"

namespace viewloom {
namespace {

constexpr int64_t kSyncInterval_ns = 2'000'000'000;
// Bytes that OpenH264 holds for each pixel: its references, its copy of the picture, and its output
// (tests/performance.md).
constexpr uint64_t kEncoderBytesPerPx = 16;

VideoFormat formatOf(const MovieCoding& coding) {
  return {.size_px = coding.video.picture_px, .qp = coding.qp, .thread_count = coding.thread_count};
}

}  // namespace

absl::StatusOr<std::unique_ptr<MovieCoder>> MovieCoder::make(const MovieCoding& coding) {
  auto begun = coding.encoders->begin(formatOf(coding));
  VIEWLOOM_RETURN_IF_ERROR(begun.status());
  return std::unique_ptr<MovieCoder>(new MovieCoder(coding, *std::move(begun)));
}

uint64_t MovieCoder::memoryBytes(const MovieCoding& coding) {
  return TiledPicture::memoryBytes(coding.atlas, coding.video) +
         kEncoderBytesPerPx * coding.video.picture_px.area();
}

MovieCoder::MovieCoder(const MovieCoding& coding, VideoEncoderChoice::Begun begun)
    : picture_(coding.atlas, coding.video),
      format_(formatOf(coding)),
      encoders_(coding.encoders),
      kind_(std::move(begun.kind)),
      encoder_(std::move(begun.encoder)) {}

absl::StatusOr<std::span<const uint8_t>> MovieCoder::code(const AtlasColors& colors,
                                                          int64_t time_ns) {
  newest_ = picture_.make(colors);
  return codeAgain(time_ns);
}

absl::StatusOr<std::span<const uint8_t>> MovieCoder::codeAgain(int64_t time_ns) {
  if (!encoder_) return failure_;
  const bool is_sync = needs_sync_ || time_ns - sync_ns_ >= kSyncInterval_ns;
  const Reference reference = is_sync ? Reference::kNone : Reference::kPictureBefore;
  needs_sync_ = true;  // also after an error
  VIEWLOOM_RETURN_IF_ERROR(encode(reference, time_ns));
  needs_sync_ = false;
  if (is_sync) sync_ns_ = time_ns;
  return access_unit_;
}

absl::Status MovieCoder::encode(Reference reference, int64_t time_ns) {
  const absl::Status coded = encoder_->encode(newest_, reference, access_unit_);
  has_coded_ |= coded.ok();
  if (coded.ok() || absl::IsInvalidArgument(coded)) return coded;
  encoder_.reset();  // before the next one: devices have few
  const std::string name = kind_.name;
  const bool is_soon = anew_ns_ && time_ns - *anew_ns_ < kSyncInterval_ns;
  const absl::Status again = is_soon ? coded : encodeAnew(coded, time_ns);
  if (again.ok()) return again;
  encoder_.reset();
  if (name != kOpenH264Name) encoders_->noteFailure(coded);
  failure_ = absl::Status(
      coded.code(), strCat("the video encoder ", name, " has failed twice: ", again.message()));
  return failure_;
}

absl::Status MovieCoder::encodeAnew(const absl::Status& failure, int64_t time_ns) {
  if (!has_coded_ && kind_.name != kOpenH264Name) {
    encoders_->noteFailure(failure);
    kind_ = openH264Kind();
  }
  auto encoder = kind_.make(format_);
  VIEWLOOM_RETURN_IF_ERROR(encoder.status());
  encoder_ = *std::move(encoder);
  VIEWLOOM_RETURN_IF_ERROR(encoder_->encode(newest_, Reference::kNone, access_unit_));
  has_coded_ = true;
  anew_ns_ = sync_ns_ = time_ns;
  log(LogLevel::kWarning, "video: an encoder has failed: ", failure.message(), "; ", kind_.name,
      " was started again, and the video goes on");
  return absl::OkStatus();
}

}  // namespace viewloom
