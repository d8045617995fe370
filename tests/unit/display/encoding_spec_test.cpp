// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <utility>

#include "display/display_spec.h"

namespace viewloom::encoding_spec_test {
namespace {

TEST(Encoding, matchesTheQuantisationOfVideoToTheQualityOfJpeg) {
  EXPECT_EQ(matchedVideoQp(85), 24u);
  EXPECT_EQ(matchedVideoQp(60), 30u);
  for (uint32_t quality = 1; quality < 100; ++quality) {
    EXPECT_GE(matchedVideoQp(quality), matchedVideoQp(quality + 1)) << quality;
    EXPECT_LE(matchedVideoQp(quality), 51u);
  }
  EXPECT_GE(matchedVideoQp(100), 20u);
}

TEST(Encoding, refusesVideoWherePixelsAreNoViews) {
  const EncodingSpec video = {.color = BandEncoding::kH264};
  const auto codeOf = [&](DisplayKind kind) {
    const auto spec = completeDisplaySpec({.kind = std::move(kind)});
    EXPECT_TRUE(spec.ok()) << spec.status();
    return validateEncodingOf(*spec, video).code();
  };
  EXPECT_EQ(codeOf(QuiltSpec{.preset = "portrait"}), absl::StatusCode::kOk);
  EXPECT_EQ(codeOf(StereoSpec{.eye_size_px = {640, 480}}), absl::StatusCode::kOk);
  EXPECT_EQ(codeOf(StereoSpec{.eye_size_px = {4096, 4096}}), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(codeOf(IntegralSpec{.preset = "near_eye_2013"}), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(codeOf(RgbdSpec{.view_size_px = {640, 480}}), absl::StatusCode::kInvalidArgument);
}

TEST(Encoding, refusesVideoOfDepth) {
  EXPECT_FALSE(validateEncodingSpec({.planes = BandEncoding::kH264}).ok());
  EXPECT_FALSE(validateEncodingSpec({.video_qp = 52}).ok());
  EXPECT_FALSE(validateEncodingSpec({.video_qp = 19}).ok());
}

TEST(EncodingKey, ignoresWhatDoesNotReachTheBytes) {
  EXPECT_EQ(encodingKey({.color = BandEncoding::kZstd, .jpeg_quality = 10}),
            encodingKey({.color = BandEncoding::kZstd, .jpeg_quality = 90}));
  EXPECT_EQ(encodingKey({.planes = BandEncoding::kRaw}), encodingKey({}));
  EXPECT_NE(encodingKey({.jpeg_quality = 10}), encodingKey({.jpeg_quality = 90}));
  EXPECT_NE(encodingKey({.chroma = Chroma::k444}), encodingKey({}));
  EXPECT_EQ(encodingKey({.color = BandEncoding::kJpegPlanes, .chroma = Chroma::k444}),
            encodingKey({.color = BandEncoding::kJpegPlanes}));
  EXPECT_NE(encodingKey({.color = BandEncoding::kJpegPlanes}), encodingKey({}));
  EXPECT_EQ(encodingKey({.video_qp = 10}), encodingKey({.video_qp = 20}));
  EXPECT_NE(encodingKey({.color = BandEncoding::kH264, .video_qp = 10}),
            encodingKey({.color = BandEncoding::kH264, .video_qp = 20}));
  const EncodingSpec adapting = {.color = BandEncoding::kH264, .video_qp = 20, .video_qp_max = 36};
  EncodingSpec limited = adapting;
  limited.bits_per_second_max = 8'000'000;
  EXPECT_NE(encodingKey(adapting), encodingKey({.color = BandEncoding::kH264, .video_qp = 20}));
  EXPECT_NE(encodingKey(adapting), encodingKey(limited));
  EXPECT_NE(encodingKey(adapting), encodingKey(onOtherRung(adapting)));
  EXPECT_EQ(arrangementKey(adapting), arrangementKey(onOtherRung(adapting)));
  EXPECT_EQ(onOtherRung(onOtherRung(adapting)), adapting);
  EXPECT_EQ(rungNumber(onOtherRung(adapting)), 2u);
  EXPECT_EQ(rungNumber({.color = BandEncoding::kH264, .bits_per_second_max = 1'000'000}), 0u);
  EXPECT_NE(arrangementKey({.color = BandEncoding::kH264}), arrangementKey({}));
  const EncodingSpec chained = {.color = BandEncoding::kH264,
                                .prediction = Prediction::kAcrossAtlases};
  EXPECT_NE(encodingKey(chained), encodingKey({.color = BandEncoding::kH264}));
  EXPECT_NE(arrangementKey(chained), arrangementKey({.color = BandEncoding::kH264}));
  EXPECT_EQ(encodingKey({.prediction = Prediction::kAcrossAtlases}), encodingKey({}));
  EXPECT_NE(encodingKey({.with_mask = true}), encodingKey({.with_depth = true}));
}

}  // namespace
}  // namespace viewloom::encoding_spec_test
