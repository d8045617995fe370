// SPDX-License-Identifier: Apache-2.0
#include "messages/accepted_encoding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "messages/display_from_proto.h"

namespace viewloom::accepted_encoding_test {
namespace {

DisplaySpec displayOf(const std::string& preset) {
  v1::Display proto;
  proto.set_preset(preset);
  const absl::StatusOr<DisplaySpec> spec = displayFromProto(proto);
  EXPECT_TRUE(spec.ok()) << spec.status();
  return spec.value_or(DisplaySpec{});
}

DisplaySpec panel() {
  v1::Display proto;
  proto.mutable_integral()->set_preset("near_eye_2013");
  const absl::StatusOr<DisplaySpec> spec = displayFromProto(proto);
  EXPECT_TRUE(spec.ok()) << spec.status();
  return spec.value_or(DisplaySpec{});
}

AcceptedEncodings accepting(std::initializer_list<v1::BandEncoding> colors) {
  AcceptedEncodings accepted;
  for (const v1::BandEncoding color : colors) accepted.Add()->set_color(color);
  return accepted;
}

TEST(AcceptedEncoding, staysJpegForClientsThatSayNothing) {
  const auto encoding = chooseEncoding({}, {}, displayOf("portrait"));
  ASSERT_TRUE(encoding.ok()) << encoding.status();
  EXPECT_EQ(encoding->color, BandEncoding::kJpeg);
}

TEST(AcceptedEncoding, takesTheFirstThatServesTheDisplay) {
  const AcceptedEncodings accepted = accepting({v1::BAND_ENCODING_H264, v1::BAND_ENCODING_JPEG});
  const auto quilt = chooseEncoding({}, accepted, displayOf("portrait"));
  ASSERT_TRUE(quilt.ok()) << quilt.status();
  EXPECT_EQ(quilt->color, BandEncoding::kH264);
  EXPECT_EQ(quilt->video_qp, matchedVideoQp(85));
  const auto of_panel = chooseEncoding({}, accepted, panel());
  ASSERT_TRUE(of_panel.ok()) << of_panel.status();
  EXPECT_EQ(of_panel->color, BandEncoding::kJpeg);
}

TEST(AcceptedEncoding, triesOnlySoMany) {
  AcceptedEncodings accepted;
  for (int i = 0; i < 32; ++i) accepted.Add()->set_color(v1::BAND_ENCODING_H264);
  EXPECT_TRUE(chooseEncoding({}, accepted, displayOf("portrait")).ok());
  accepted.Add()->set_color(v1::BAND_ENCODING_JPEG);
  const absl::Status status = chooseEncoding({}, accepted, displayOf("portrait")).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(fieldOf(status), "accepted");
  v1::AtlasEncoding jpeg;
  jpeg.set_color(v1::BAND_ENCODING_JPEG);
  EXPECT_FALSE(chooseEncoding(jpeg, accepted, displayOf("portrait")).ok());
}

TEST(AcceptedEncoding, takesItsUsualChoiceForAnEntryWithoutColor) {
  const AcceptedEncodings accepted =
      accepting({v1::BAND_ENCODING_H264, v1::BAND_ENCODING_UNSPECIFIED});
  EXPECT_EQ(chooseEncoding({}, accepted, displayOf("portrait"))->color, BandEncoding::kH264);
  EXPECT_EQ(chooseEncoding({}, accepted, panel())->color, chooseEncoding({}, {}, panel())->color);
}

TEST(AcceptedEncoding, keepsToTheLimitsOfADecoder) {
  AcceptedEncodings accepted = accepting({v1::BAND_ENCODING_H264, v1::BAND_ENCODING_ZSTD});
  accepted[0].set_level_max(30);
  const auto by_level = chooseEncoding({}, accepted, displayOf("portrait"));
  ASSERT_TRUE(by_level.ok()) << by_level.status();
  EXPECT_EQ(by_level->color, BandEncoding::kZstd);
  accepted[0].set_level_max(32);
  EXPECT_EQ(chooseEncoding({}, accepted, displayOf("portrait"))->color, BandEncoding::kH264);
  accepted[0].mutable_picture_size_max()->set_height(1000);
  EXPECT_EQ(chooseEncoding({}, accepted, displayOf("portrait"))->color, BandEncoding::kZstd);
}

TEST(AcceptedEncoding, keepsToAColorThatIsAskedFor) {
  v1::AtlasEncoding asked;
  asked.set_color(v1::BAND_ENCODING_RAW);
  const auto encoding =
      chooseEncoding(asked, accepting({v1::BAND_ENCODING_H264}), displayOf("portrait"));
  ASSERT_TRUE(encoding.ok()) << encoding.status();
  EXPECT_EQ(encoding->color, BandEncoding::kRaw);
}

TEST(AcceptedEncoding, saysWhyNoneServes) {
  const absl::Status refused =
      chooseEncoding({}, accepting({v1::BAND_ENCODING_H264}), panel()).status();
  EXPECT_EQ(refused.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(fieldOf(refused), "accepted");
  EXPECT_THAT(std::string(refused.message()),
              testing::HasSubstr("a panel behind microlenses has another view in each pixel"));
}

TEST(AcceptedEncoding, adaptsTheQualityUnlessAQuantisationIsGivenAlone) {
  v1::AtlasEncoding asked;
  EXPECT_FALSE(adaptsToLines(*chooseEncoding(asked, {}, displayOf("portrait")))) << "JPEG";
  asked.set_color(v1::BAND_ENCODING_H264);
  const auto open = chooseEncoding(asked, {}, displayOf("portrait"));
  EXPECT_EQ(open->video_qp_max, open->video_qp + 16);
  asked.set_video_qp(30);
  EXPECT_FALSE(adaptsToLines(*chooseEncoding(asked, {}, displayOf("portrait"))));
  asked.set_bits_per_second_max(8'000'000);
  const auto limited = chooseEncoding(asked, {}, displayOf("portrait"));
  EXPECT_EQ(limited->video_qp, 30u);
  EXPECT_EQ(limited->video_qp_max, 46u);
  EXPECT_EQ(limited->bits_per_second_max, 8'000'000u);
  asked.set_video_qp(51);
  EXPECT_TRUE(adaptsToLines(*chooseEncoding(asked, {}, displayOf("portrait"))))
      << "the limit holds";
}

TEST(AcceptedEncoding, namesTheFieldOfAWrongEncoding) {
  v1::AtlasEncoding asked;
  asked.set_color(v1::BAND_ENCODING_H264);
  EXPECT_EQ(fieldOf(chooseEncoding(asked, {}, panel()).status()), "encoding.color");
  asked.set_video_qp(52);
  EXPECT_EQ(fieldOf(chooseEncoding(asked, {}, displayOf("portrait")).status()),
            "encoding.video_qp");
  asked.clear_video_qp();
}

TEST(AcceptedEncoding, chainsAtlasesWhereThatIsAskedFor) {
  v1::AtlasEncoding asked;
  asked.set_color(v1::BAND_ENCODING_H264);
  EXPECT_FALSE(isChained(*chooseEncoding(asked, {}, displayOf("portrait"))));
  asked.set_prediction(v1::PREDICTION_ACROSS_ATLASES);
  EXPECT_TRUE(isChained(*chooseEncoding(asked, {}, displayOf("portrait"))));
  asked.set_color(v1::BAND_ENCODING_JPEG);
  EXPECT_FALSE(isChained(*chooseEncoding(asked, {}, displayOf("portrait"))));
  // Pictures of a Portrait have 840x1120 px.
  asked.clear_color();
  AcceptedEncodings accepted = accepting({v1::BAND_ENCODING_H264, v1::BAND_ENCODING_ZSTD});
  EXPECT_TRUE(isChained(*chooseEncoding(asked, accepted, displayOf("portrait"))));
  accepted[0].mutable_picture_size_max()->set_width(800);
  EXPECT_EQ(chooseEncoding(asked, accepted, displayOf("portrait"))->color, BandEncoding::kZstd);
}

}  // namespace
}  // namespace viewloom::accepted_encoding_test
