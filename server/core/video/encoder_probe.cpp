// SPDX-License-Identifier: Apache-2.0
#include "video/encoder_probe.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "absl/strings/str_format.h"
#include "base/str_cat.h"
#include "video/annex_b.h"
#include "video/h264_parameters.h"
#include "video/openh264_decoder.h"

namespace viewloom {
namespace {

constexpr int kAtlasCount = 2;
constexpr int kPicturesPerAtlas = 4;
constexpr VideoFormat kProbeFormat = {.size_px = kProbePicture_px, .qp = 26};
// OpenH264 has 42 dB. An encoder that takes the quantisation for another thing has less.
constexpr double kPsnrMin_db = 37;

using ProbeClock = std::chrono::steady_clock;

// Waves and edges that move by 2 px from picture to picture, as views do. Another pattern in each
// plane, so that planes that are exchanged are found.
class ProbePicture {
 public:
  explicit ProbePicture(int number) {
    const double moved_px = 2.0 * number;
    fill(luma_, kProbePicture_px.width, [&](double x, double y) {
      const bool is_bright = std::fmod(x - moved_px + 1000, 96) < 48;
      return (is_bright ? 150 : 90) + 40 * std::sin((x - moved_px) / 13) * std::cos(y / 17);
    });
    fill(cb_, kProbePicture_px.width / 2,
         [&](double x, double y) { return 128 + 60 * std::sin((2 * x - moved_px) / 29 + y / 41); });
    fill(cr_, kProbePicture_px.width / 2,
         [&](double x, double y) { return 128 + 60 * std::cos((2 * x - moved_px) / 37 - y / 23); });
  }

  VideoPicture video() const {
    return {.size_px = kProbePicture_px,
            .y = luma_.data(),
            .cb = cb_.data(),
            .cr = cr_.data(),
            .y_stride_bytes = kProbePicture_px.width,
            .chroma_stride_bytes = kProbePicture_px.width / 2};
  }

 private:
  template <typename Pattern>
  static void fill(std::vector<uint8_t>& plane, uint32_t width_px, const Pattern& pattern) {
    const uint32_t height_px = width_px * kProbePicture_px.height / kProbePicture_px.width;
    for (uint32_t y = 0; y < height_px; ++y) {
      for (uint32_t x = 0; x < width_px; ++x) plane.push_back(uint8_t(std::lround(pattern(x, y))));
    }
  }

  std::vector<uint8_t> luma_;
  std::vector<uint8_t> cb_;
  std::vector<uint8_t> cr_;
};

struct ProbePlane {
  const uint8_t* samples;
  size_t stride_bytes;
};

double psnrOf(const ProbePlane& made, const ProbePlane& wanted, uint32_t divisor) {
  const uint32_t width_px = kProbePicture_px.width / divisor;
  const uint32_t height_px = kProbePicture_px.height / divisor;
  double sum = 0;
  for (uint32_t y = 0; y < height_px; ++y) {
    for (uint32_t x = 0; x < width_px; ++x) {
      const double error = double(made.samples[y * made.stride_bytes + x]) -
                           wanted.samples[y * wanted.stride_bytes + x];
      sum += error * error;
    }
  }
  constexpr double kLeastError = 1e-6;  // of planes that are the same
  return 10 * std::log10(255.0 * 255.0 / std::max(sum / width_px / height_px, kLeastError));
}

double leastPsnr(const VideoPicture& made, const VideoPicture& wanted) {
  return std::min(
      {psnrOf({made.y, made.y_stride_bytes}, {wanted.y, wanted.y_stride_bytes}, 1),
       psnrOf({made.cb, made.chroma_stride_bytes}, {wanted.cb, wanted.chroma_stride_bytes}, 2),
       psnrOf({made.cr, made.chroma_stride_bytes}, {wanted.cr, wanted.chroma_stride_bytes}, 2)});
}

absl::Status failProbe(std::string_view problem) {
  return absl::FailedPreconditionError(strCat(problem));
}

// Whether pictures follow each other as proto BandEncoding H264 says.
absl::Status checkForm(std::span<const uint8_t> access_unit, Reference reference) {
  for (const NalUnit& unit : nalUnits(access_unit)) {
    const bool is_asked =
        (unit.type() == NalType::kSlice) == (reference == Reference::kPictureBefore);
    if (!is_asked) return failProbe("it chooses itself which picture refers to another");
  }
  if (reference == Reference::kPictureBefore) return absl::OkStatus();
  const absl::StatusOr<H264Parameters> parameters = h264ParametersOf(access_unit);
  VIEWLOOM_RETURN_IF_ERROR(parameters.status());
  if (h264CodecString(*parameters) != codedVideoString(kProbePicture_px)) {
    return failProbe(strCat("its stream is ", h264CodecString(*parameters), " instead of ",
                            codedVideoString(kProbePicture_px)));
  }
  if (parameters->color != kVideoColor) return failProbe("its stream says other colours");
  if (parameters->reorder_count != 0) return failProbe("its stream may change the order");
  return absl::OkStatus();
}

absl::Status encodeAndCompare(const VideoEncoderKind& kind, EncoderProbe& probe) {
  const absl::StatusOr<std::unique_ptr<VideoEncoder>> encoder = kind.make(kProbeFormat);
  VIEWLOOM_RETURN_IF_ERROR(encoder.status());
  const absl::StatusOr<std::unique_ptr<OpenH264Decoder>> decoder = OpenH264Decoder::make();
  VIEWLOOM_RETURN_IF_ERROR(decoder.status());
  constexpr int kPictureCount = kAtlasCount * kPicturesPerAtlas;
  probe.psnr_db = std::numeric_limits<double>::max();
  std::vector<uint8_t> access_unit;
  ProbeClock::duration spent{};
  for (int i = 0; i < kPictureCount; ++i) {
    const ProbePicture picture(i);
    const Reference reference =
        i % kPicturesPerAtlas == 0 ? Reference::kNone : Reference::kPictureBefore;
    const ProbeClock::time_point begun = ProbeClock::now();
    VIEWLOOM_RETURN_IF_ERROR((*encoder)->encode(picture.video(), reference, access_unit));
    spent += ProbeClock::now() - begun;
    VIEWLOOM_RETURN_IF_ERROR(checkForm(access_unit, reference));
    const auto decoded = (*decoder)->decode(access_unit, kProbePicture_px);
    VIEWLOOM_RETURN_IF_ERROR(decoded.status());
    probe.psnr_db = std::min(probe.psnr_db, leastPsnr(*decoded, picture.video()));
  }
  probe.picture_ms = std::chrono::duration<double, std::milli>(spent).count() / kPictureCount;
  if (probe.psnr_db >= kPsnrMin_db) return absl::OkStatus();
  return failProbe(absl::StrFormat("its pictures have %.1f dB; expected are at least %.0f dB",
                                   probe.psnr_db, kPsnrMin_db));
}

}  // namespace

EncoderProbe probeVideoEncoder(const VideoEncoderKind& kind) {
  EncoderProbe probe{.name = kind.name, .library = kind.library};
  probe.status = encodeAndCompare(kind, probe);
  return probe;
}

}  // namespace viewloom
