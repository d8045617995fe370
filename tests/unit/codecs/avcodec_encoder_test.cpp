// SPDX-License-Identifier: Apache-2.0
// Encoders of libavcodec, with x264 in place of a GPU.
#include "codecs/avcodec_encoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "codecs/video_kinds.h"
#include "mp4/avc_track.h"
#include "mp4/movie_coder.h"
#include "support/video/coded_texture.h"
#include "video/encoder_choice.h"
#include "video/h264_parameters.h"
#include "video/openh264_decoder.h"

namespace viewloom::test::avcodec_encoder_test {
namespace {

VideoEncoderKind kindOf(std::string_view name) {
  for (const VideoEncoderKind& kind : videoEncoderKinds()) {
    if (kind.name == name) return kind;
  }
  ADD_FAILURE() << name;
  return {};
}

std::unique_ptr<VideoEncoder> encoderOf(const VideoFormat& format) {
  auto encoder = kindOf("libx264").make(format);
  EXPECT_TRUE(encoder.ok()) << encoder.status();
  return *std::move(encoder);
}

TEST(AvcodecEncoder, passesTheProbe) {
  const EncoderProbe probe = probeVideoEncoder(kindOf("libx264"));
  EXPECT_TRUE(probe.status.ok()) << probe.status;
  EXPECT_THAT(probe.library, testing::StartsWith("libavcodec "));
  EXPECT_GT(probe.psnr_db, 38);
}

TEST(AvcodecEncoder, makesTheStreamThatOpenH264Makes) {
  const SizePx size_px{322, 202};
  const auto encoder = encoderOf({.size_px = size_px, .qp = 22});
  const std::vector<AccessUnit> units = codedTexture(*encoder, 8, 4);
  auto decoder = OpenH264Decoder::make();
  for (int i = 0; i < 8; ++i) {
    const AccessUnit& unit = units[size_t(i)];
    if (i % 4 == 0) {
      EXPECT_THAT(typesOf(unit),
                  testing::ElementsAre(NalType::kSequenceParameters, NalType::kPictureParameters,
                                       NalType::kIdrSlice));
      const auto parameters = h264ParametersOf(unit);
      ASSERT_TRUE(parameters.ok()) << parameters.status();
      EXPECT_EQ(h264CodecString(*parameters), codedVideoString(size_px));
      EXPECT_EQ(parameters->color, kVideoColor);
      EXPECT_EQ(parameters->reorder_count, 0u);
      EXPECT_EQ(parameters->reference_count, 1u);
    } else {
      EXPECT_THAT(typesOf(unit), testing::ElementsAre(NalType::kSlice));
    }
    const auto picture = (*decoder)->decode(unit, size_px);
    ASSERT_TRUE(picture.ok()) << picture.status();
    EXPECT_GT(psnrOfLuma(*picture, SamplePicture::texture(size_px, 2 * i).video()), 42);
  }
}

TEST(AvcodecEncoder, keepsFlatPatchesWithinOneCode) {
  const SizePx size_px{128, 96};
  const auto encoder = encoderOf({.size_px = size_px, .qp = 26});
  auto decoder = OpenH264Decoder::make();
  for (const int code : {0, 37, 200, 255}) {
    const SamplePicture patch =
        SamplePicture::flat(size_px, uint8_t(code), uint8_t(255 - code), 90);
    AccessUnit unit;
    ASSERT_TRUE(encoder->encode(patch.video(), Reference::kNone, unit).ok());
    const auto picture = (*decoder)->decode(unit, size_px);
    ASSERT_TRUE(picture.ok()) << picture.status();
    EXPECT_NEAR(picture->y[0], code, 1);
    EXPECT_NEAR(picture->cb[0], 255 - code, 1);
    EXPECT_NEAR(picture->cr[0], 90, 1);
  }
}

// The same quantisation means about the same error and bytes as with OpenH264.
TEST(AvcodecEncoder, takesTheQuantisation) {
  const auto bytesAt = [](uint32_t qp) {
    const auto encoder = encoderOf({.size_px = {320, 240}, .qp = qp});
    size_t bytes = 0;
    for (const AccessUnit& unit : codedTexture(*encoder, 4, 4)) bytes += unit.size();
    return bytes;
  };
  EXPECT_GT(bytesAt(kVideoQpMin), bytesAt(30));
  EXPECT_GT(bytesAt(30), bytesAt(kVideoQpMax));
}

TEST(AvcodecEncoder, changesTheQuantisationBetweenPictures) {
  const SizePx size_px{320, 240};
  const auto encoder = encoderOf({.size_px = size_px, .qp = 24});
  auto decoder = OpenH264Decoder::make();
  std::vector<bool> are_idr;
  std::vector<double> psnr_db;
  for (const uint32_t qp : {24u, 24u, 51u, 51u, 20u}) {
    ASSERT_TRUE(encoder->setQp(qp).ok());
    EXPECT_EQ(encoder->format().qp, qp);
    const SamplePicture sample = SamplePicture::texture(size_px, 2 * int(are_idr.size()));
    AccessUnit unit;
    const absl::Status status = encoder->encode(sample.video(), Reference::kPictureBefore, unit);
    ASSERT_TRUE(status.ok()) << status;
    are_idr.push_back(typesOf(unit).back() == NalType::kIdrSlice);
    const auto picture = (*decoder)->decode(unit, size_px);
    ASSERT_TRUE(picture.ok()) << picture.status();
    psnr_db.push_back(psnrOfLuma(*picture, sample.video()));
  }
  EXPECT_EQ(are_idr, (std::vector<bool>{true, false, true, false, true}));
  EXPECT_LT(psnr_db[2], psnr_db[1] - 6);
  EXPECT_GT(psnr_db[4], psnr_db[3] + 6);
  EXPECT_EQ(encoder->setQp(kVideoQpMin - 1).code(), absl::StatusCode::kInvalidArgument);
}

TEST(AvcodecEncoder, codesSlicesOnSeveralThreads) {
  const auto encoder = encoderOf({.size_px = {640, 480}, .thread_count = 3});
  EXPECT_EQ(typesOf(codedTexture(*encoder, 2, 2)[1]), std::vector<NalType>(3, NalType::kSlice));
}

TEST(AvcodecEncoder, takesWholePortraitQuilts) {
  const SizePx size_px{3360, 3360};
  const auto encoder = encoderOf({.size_px = size_px, .qp = 30, .thread_count = 2});
  const auto parameters = h264ParametersOf(codedTexture(*encoder, 1, 1).front());
  ASSERT_TRUE(parameters.ok()) << parameters.status();
  EXPECT_EQ(parameters->size_px, size_px);
  EXPECT_EQ(parameters->level, 60);
}

// A movie of a quilt that OpenH264 would scale.
TEST(AvcodecEncoder, writesMoviesOfWholeQuilts) {
  const auto choice = VideoEncoderChoice::choose(videoEncoderKinds(), "libx264");
  ASSERT_TRUE(choice.ok()) << choice.status();
  const AtlasTiles quilt = {
      .atlas_px = {3360, 3360}, .tile_px = {420, 560}, .columns = 8, .rows = 6};
  const auto tiles = fitVideoTiles(quilt, (*choice)->limit());
  ASSERT_TRUE(tiles.ok()) << tiles.status();
  EXPECT_EQ(scalingNote(quilt, *tiles), "");
  const auto coder = MovieCoder::make(
      {.atlas = quilt, .video = *tiles, .qp = 40, .thread_count = 2, .encoders = *choice});
  ASSERT_TRUE(coder.ok()) << coder.status();
  const std::vector<uint8_t> rgb(quilt.atlas_px.area() * 3, 90);
  const auto unit = (*coder)->code({.samples = rgb.data()}, 0);
  ASSERT_TRUE(unit.ok()) << unit.status();
  const auto track = readAvcTrack(*unit);
  ASSERT_TRUE(track.ok()) << track.status();
  EXPECT_EQ(track->parameters.size_px, quilt.atlas_px);
  EXPECT_EQ(h264CodecString(track->parameters), "avc1.4D4C3C");
}

TEST(AvcodecEncoder, refusesFormatsThatItCannotCode) {
  for (const VideoFormat& format :
       {VideoFormat{.size_px = {33, 32}}, VideoFormat{.size_px = {8192, 8192}},
        VideoFormat{.size_px = {64, 64}, .qp = kVideoQpMin - 1},
        VideoFormat{.size_px = {64, 64}, .qp = kVideoQpMax + 1}}) {
    EXPECT_EQ(kindOf("libx264").make(format).status().code(), absl::StatusCode::kInvalidArgument);
  }
  const auto encoder = encoderOf({.size_px = {64, 64}});
  AccessUnit unit;
  EXPECT_EQ(encoder->encode(SamplePicture::flat({64, 32}, 0, 0, 0).video(), Reference::kNone, unit)
                .code(),
            absl::StatusCode::kInvalidArgument);
}

TEST(AvcodecEncoder, saysWhyAnEncoderIsMissing) {
  const auto made = AvcodecEncoder::make({.name = "h264_none"}, {.size_px = {64, 64}});
  EXPECT_EQ(made.status().code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(made.status().message(), "libavcodec was built without it");
}

// Machines with a GPU take theirs, and the others OpenH264.
TEST(VideoEncoderKinds, serveEveryMachine) {
  const auto choice =
      VideoEncoderChoice::choose(videoEncoderKinds(), VideoEncoderChoice::kAutomatic);
  ASSERT_TRUE(choice.ok()) << choice.status();
  for (const EncoderProbe& probe : (*choice)->probes()) {
    EXPECT_NE(probe.name, "libx264") << "it is taken only by its name";
    EXPECT_TRUE(probe.status.ok() || absl::IsUnavailable(probe.status)) << probe.status;
  }
  EXPECT_TRUE((*choice)->make({.size_px = {64, 64}}).ok());
}

}  // namespace
}  // namespace viewloom::test::avcodec_encoder_test
