// SPDX-License-Identifier: Apache-2.0
#include "video/encoder_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/video/sample_picture.h"
#include "unit/video/planned_encoder.h"
#include "video/annex_b.h"
#include "video/openh264_decoder.h"
#include "video/openh264_encoder.h"

namespace viewloom::test::encoder_choice_test {
namespace {

constexpr SizePx kSize_px{64, 48};

VideoEncoderChoicePtr chosen(const std::vector<VideoEncoderKind>& kinds, std::string_view wanted) {
  auto choice = VideoEncoderChoice::choose(kinds, wanted);
  EXPECT_TRUE(choice.ok()) << choice.status();
  return *std::move(choice);
}

std::string nameOf(const std::vector<VideoEncoderKind>& kinds, std::string_view wanted) {
  const std::string text = chosen(kinds, wanted)->text();
  return text.substr(0, text.find(' '));
}

VideoEncoderKind unnamedOnly(VideoEncoderKind kind) {
  kind.is_automatic = false;
  return kind;
}

TEST(VideoEncoderChoice, takesTheFirstThatPasses) {
  const VideoEncoderKind good = plannedKind("good", {});
  EXPECT_EQ(nameOf({missingKind("missing"), good, openH264Kind()}, "auto"), "good");
  EXPECT_EQ(nameOf({missingKind("missing"), openH264Kind()}, "auto"), "openh264");
  EXPECT_EQ(nameOf({unnamedOnly(good), openH264Kind()}, "auto"), "openh264");
}

TEST(VideoEncoderChoice, takesWhatIsNamed) {
  const std::vector<VideoEncoderKind> kinds = {
      plannedKind("good", {}), unnamedOnly(plannedKind("named", {})), openH264Kind()};
  EXPECT_EQ(nameOf(kinds, "named"), "named");
  EXPECT_EQ(nameOf(kinds, "openh264"), "openh264");
}

TEST(VideoEncoderChoice, takesOpenH264WhereTheNamedOneFails) {
  const VideoEncoderChoicePtr choice =
      chosen({missingKind("missing"), plannedKind("good", {}), openH264Kind()}, "missing");
  EXPECT_THAT(choice->text(), testing::StartsWith("openh264 (OpenH264 2."));
  ASSERT_EQ(choice->probes().size(), 1u);
  EXPECT_EQ(choice->probes().front().status.message(), "there is no such device");
}

TEST(VideoEncoderChoice, namesTheEncodersThereAre) {
  const auto choice =
      VideoEncoderChoice::choose({missingKind("h264_nvenc"), openH264Kind()}, "nvenc");
  EXPECT_EQ(choice.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(choice.status().message(),
            "\"nvenc\": this program has no such encoder; accepted is auto, h264_nvenc, openh264");
}

TEST(VideoEncoderChoice, goesOnWithOpenH264InTheMiddleOfAnAtlas) {
  const VideoEncoderChoicePtr choice =
      chosen({plannedKind("lost", failingFrom(12)), openH264Kind()}, "auto");
  ASSERT_THAT(choice->text(), testing::StartsWith("lost"));
  auto encoder = choice->make({.size_px = kSize_px});
  ASSERT_TRUE(encoder.ok()) << encoder.status();
  auto decoder = OpenH264Decoder::make();
  std::vector<uint8_t> unit;
  std::vector<int> sync_pictures;
  for (int i = 0; i < 15; ++i) {
    const SamplePicture picture = SamplePicture::texture(kSize_px, 2 * i);
    const Reference reference = i % 5 == 0 ? Reference::kNone : Reference::kPictureBefore;
    const absl::Status coded = (*encoder)->encode(picture.video(), reference, unit);
    ASSERT_TRUE(coded.ok()) << coded;
    if (nalUnits(unit).back().type() == NalType::kIdrSlice) sync_pictures.push_back(i);
    const auto decoded = (*decoder)->decode(unit, kSize_px);
    ASSERT_TRUE(decoded.ok()) << i << ": " << decoded.status();
    EXPECT_GT(psnrOfLuma(*decoded, picture.video()), 38);
  }
  EXPECT_THAT(sync_pictures, testing::ElementsAre(0, 5, 10, 12));
  EXPECT_EQ((*encoder)->format().size_px, kSize_px);
}

TEST(VideoEncoderChoice, doesNotTryALostDeviceAgain) {
  const VideoEncoderChoicePtr choice =
      chosen({plannedKind("lost", failingFrom(8)), openH264Kind()}, "auto");
  const auto isOpenH264 = [&] {
    const auto encoder = choice->make({.size_px = kSize_px});
    return dynamic_cast<OpenH264Encoder*>(encoder->get()) != nullptr;
  };
  EXPECT_FALSE(isOpenH264());
  const auto encoder = choice->make({.size_px = kSize_px});
  std::vector<uint8_t> unit;
  for (int i = 0; i < 9; ++i) {
    const SamplePicture picture = SamplePicture::texture(kSize_px, i);
    EXPECT_TRUE((*encoder)->encode(picture.video(), Reference::kPictureBefore, unit).ok());
  }
  EXPECT_TRUE(isOpenH264());
}

TEST(VideoEncoderChoice, keepsTheLimitThatTheMachineHas) {
  VideoEncoderKind large = plannedKind("large", {});
  large.limit = {.area_max_px = kVideoAreaOfLevel6_px};
  EXPECT_TRUE(chosen({large, openH264Kind()}, "auto")->limit().holds({3360, 3360}));
  large.tried_px = {3360, 3360};  // which this encoder refuses
  EXPECT_FALSE(chosen({large, openH264Kind()}, "auto")->limit().holds({3360, 3360}));
}

TEST(VideoEncoderChoice, makesOpenH264WhereAnotherCannotBeMade) {
  VideoEncoderKind large = plannedKind("large", {});
  large.make = [make = large.make](
                   const VideoFormat& format) -> absl::StatusOr<std::unique_ptr<VideoEncoder>> {
    if (format.size_px.width < 128) return absl::InternalError("too small");
    return make(format);
  };
  const VideoEncoderChoicePtr choice = chosen({large, openH264Kind()}, "auto");
  ASSERT_THAT(choice->text(), testing::StartsWith("large"));
  EXPECT_TRUE(choice->make({.size_px = kSize_px}).ok());
  EXPECT_EQ(choice->make({.size_px = {15, 15}}).status().code(),
            absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace viewloom::test::encoder_choice_test
