// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/video/coded_texture.h"
#include "video/h264_parameters.h"
#include "video/openh264_decoder.h"
#include "video/openh264_encoder.h"
#include "video/view_format.h"

namespace viewloom::test::openh264_test {
namespace {

constexpr EntropyCoding kEntropies[] = {EntropyCoding::kArithmetic, EntropyCoding::kVariableLength};

std::unique_ptr<OpenH264Encoder> encoderOf(const VideoFormat& format) {
  auto encoder = OpenH264Encoder::make(format);
  EXPECT_TRUE(encoder.ok()) << encoder.status();
  return *std::move(encoder);
}

std::unique_ptr<OpenH264Decoder> newDecoder() {
  auto decoder = OpenH264Decoder::make();
  EXPECT_TRUE(decoder.ok()) << decoder.status();
  return *std::move(decoder);
}

AccessUnit coded(VideoEncoder& encoder, const SamplePicture& picture, Reference reference) {
  AccessUnit unit;
  const absl::Status status = encoder.encode(picture.video(), reference, unit);
  EXPECT_TRUE(status.ok()) << status;
  return unit;
}

Reference referenceOf(int picture) {
  return picture == 0 ? Reference::kNone : Reference::kPictureBefore;
}

std::vector<AccessUnit> codedStack(VideoEncoder& encoder, int count) {
  return codedTexture(encoder, count, count);
}

TEST(OpenH264, decodesEveryPictureOfAStackRightAway) {
  const SizePx size_px{322, 202};
  const auto decoder = newDecoder();
  for (const EntropyCoding entropy : kEntropies) {
    const auto encoder = encoderOf({.size_px = size_px, .qp = 22, .entropy = entropy});
    const std::vector<AccessUnit> units = codedStack(*encoder, 4);
    for (int i = 0; i < 4; ++i) {
      const auto picture = decoder->decode(units[size_t(i)], size_px);
      ASSERT_TRUE(picture.ok()) << picture.status();
      EXPECT_GT(psnrOfLuma(*picture, SamplePicture::texture(size_px, 2 * i).video()), 42);
    }
  }
}

// Chained video never begins anew for a reader that keeps up. Numbers of pictures wrap meanwhile:
// H.264 counts them in 16 bits at most.
TEST(OpenH264, goesOnPastEveryNumberOfAPicture) {
  constexpr int kPictures = 66'000;
  const SizePx size_px{16, 16};
  const auto encoder = encoderOf({.size_px = size_px, .qp = 30});
  const auto decoder = newDecoder();
  const SamplePicture pictures[] = {SamplePicture::texture(size_px, 0),
                                    SamplePicture::texture(size_px, 3)};
  for (int i = 0; i < kPictures; ++i) {
    const auto picture = decoder->decode(coded(*encoder, pictures[i % 2], referenceOf(i)), size_px);
    ASSERT_TRUE(picture.ok()) << i << ": " << picture.status();
    if (i + 4 < kPictures) continue;
    EXPECT_GT(psnrOfLuma(*picture, pictures[i % 2].video()), 30);
  }
}

TEST(OpenH264, beginsEachAtlasWithAPictureOfItsOwn) {
  const auto encoder = encoderOf({.size_px = {64, 48}});
  for (int atlas = 0; atlas < 3; ++atlas) {
    const std::vector<AccessUnit> units = codedStack(*encoder, 3);
    EXPECT_THAT(typesOf(units[0]),
                testing::ElementsAre(NalType::kSequenceParameters, NalType::kPictureParameters,
                                     NalType::kIdrSlice));
    EXPECT_THAT(typesOf(units[1]), testing::ElementsAre(NalType::kSlice));
    EXPECT_THAT(typesOf(units[2]), testing::ElementsAre(NalType::kSlice));
    EXPECT_LT(units[1].size(), units[0].size());
  }
}

TEST(OpenH264, saysColorLevelAndOrder) {
  const auto encoder = encoderOf({.size_px = {840, 1120}});
  const auto parameters = h264ParametersOf(codedStack(*encoder, 1).front());
  ASSERT_TRUE(parameters.ok()) << parameters.status();
  EXPECT_EQ(parameters->size_px, (SizePx{840, 1120}));
  EXPECT_EQ(parameters->level, h264Level({840, 1120}));
  EXPECT_EQ(h264CodecString(*parameters), "avc1.4D4C20");
  EXPECT_EQ(parameters->reorder_count, 0u);
  EXPECT_EQ(parameters->color,
            (H264Color{.is_full_range = true, .primaries = 1, .transfer = 13, .matrix = 6}));
}

TEST(OpenH264, keepsFlatPatchesWithinOneCode) {
  const SizePx size_px{128, 96};
  const auto encoder = encoderOf({.size_px = size_px, .qp = 26});
  const auto decoder = newDecoder();
  for (const int code : {0, 1, 37, 128, 200, 254, 255}) {
    const SamplePicture patch =
        SamplePicture::flat(size_px, uint8_t(code), uint8_t(255 - code), 90);
    for (int i = 0; i < 3; ++i) {
      const auto picture = decoder->decode(coded(*encoder, patch, referenceOf(i)), size_px);
      ASSERT_TRUE(picture.ok()) << picture.status();
      EXPECT_NEAR(picture->y[0], code, 1);
      EXPECT_NEAR(picture->cb[0], 255 - code, 1);
      EXPECT_NEAR(picture->cr[0], 90, 1);
    }
  }
}

TEST(OpenH264, takesPicturesFromTheSmallestToTheLargest) {
  for (const SizePx size_px : {SizePx{16, 16}, SizePx{18, 16}, SizePx{352, 288}, SizePx{720, 576},
                               SizePx{1280, 720}, SizePx{4096, 16}, SizePx{4096, 2176}}) {
    const auto encoder = encoderOf(viewFormat(size_px, 26));
    const auto decoder = newDecoder();
    const std::vector<AccessUnit> units = codedStack(*encoder, 2);
    const auto parameters = h264ParametersOf(units.front());
    ASSERT_TRUE(parameters.ok()) << parameters.status();
    EXPECT_EQ(h264CodecString(*parameters), codedVideoString(size_px));
    for (const AccessUnit& unit : units) {
      const auto picture = decoder->decode(unit, size_px);
      ASSERT_TRUE(picture.ok()) << picture.status();
      EXPECT_EQ(picture->size_px, size_px);
    }
  }
}

TEST(OpenH264, codesSlicesOnSeveralThreads) {
  const SizePx size_px{640, 480};
  const auto encoder = encoderOf({.size_px = size_px, .thread_count = 3});
  const auto decoder = newDecoder();
  const std::vector<AccessUnit> units = codedStack(*encoder, 2);
  EXPECT_EQ(typesOf(units[1]), std::vector<NalType>(3, NalType::kSlice));
  for (const AccessUnit& unit : units) EXPECT_TRUE(decoder->decode(unit, size_px).ok());
}

TEST(OpenH264, codesTheSameSlicesOnAnyThreads) {
  VideoFormat format = viewFormat({320, 1120}, 26);
  EXPECT_EQ(format.slice_count, 4u);
  const std::vector<AccessUnit> units = codedStack(*encoderOf(format), 3);
  EXPECT_EQ(typesOf(units[1]), std::vector<NalType>(4, NalType::kSlice));
  format.thread_count = 4;
  EXPECT_EQ(codedStack(*encoderOf(format), 3), units);
}

constexpr EntropyCoding kFast = EntropyCoding::kVariableLength;
// The finest ones.
constexpr VideoFormat kNoisyFormats[] = {
    {.qp = kVideoQpMin},
    {.qp = kVideoQpMin, .thread_count = 4},
    {.qp = kVideoQpMin, .entropy = kFast},
    {.qp = kVideoQpMin, .slice_count = 4, .entropy = kFast},
    {.qp = kThreadedQpMin, .thread_count = 4, .entropy = kFast},
};

// Noise takes the most bytes. An encoder may refuse it, but never writes past its buffers.
TEST(OpenH264, codesNoiseOrRefusesIt) {
  for (const SizePx size_px : {SizePx{64, 64}, SizePx{128, 128}, SizePx{256, 256}}) {
    const SamplePicture noise = SamplePicture::noise(size_px);
    for (VideoFormat format : kNoisyFormats) {
      format.size_px = size_px;
      const auto encoder = encoderOf(format);
      for (int i = 0; i < 3; ++i) {
        AccessUnit unit;
        const absl::Status status = encoder->encode(noise.video(), referenceOf(i), unit);
        EXPECT_TRUE(status.ok() || unit.empty());
      }
    }
  }
}

TEST(OpenH264, refusesFormatsThatItCannotCode) {
  for (const VideoFormat& format :
       {VideoFormat{.size_px = {15, 16}}, VideoFormat{.size_px = {33, 32}},
        VideoFormat{.size_px = {4096, 2306}},
        VideoFormat{.size_px = {64, 64}, .qp = kVideoQpMin - 1},
        VideoFormat{.size_px = {64, 64}, .qp = kVideoQpMax + 1},
        VideoFormat{.size_px = {64, 64}, .thread_count = 17},
        VideoFormat{.size_px = {64, 64},
        .qp = kThreadedQpMin - 1,
        .thread_count = 2,
        .entropy = EntropyCoding::kVariableLength},
        VideoFormat{.size_px = {64, 64}, .slice_count = 0},
        VideoFormat{.size_px = {64, 64}, .slice_count = 17}}) {
    EXPECT_EQ(OpenH264Encoder::make(format).status().code(), absl::StatusCode::kInvalidArgument);
  }
}

TEST(OpenH264, refusesToCodePicturesOfAnotherSize) {
  const auto encoder = encoderOf({.size_px = {64, 64}});
  AccessUnit unit;
  const absl::Status refused =
      encoder->encode(SamplePicture::flat({64, 32}, 0, 0, 0).video(), Reference::kNone, unit);
  EXPECT_EQ(refused.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(refused.message(), "a picture of 64x32 px for an encoder of 64x64");
  EXPECT_TRUE(unit.empty());
}

TEST(OpenH264, refusesAPictureWhoseReferenceIsMissing) {
  const SizePx size_px{64, 64};
  const auto encoder = encoderOf({.size_px = size_px});
  const std::vector<AccessUnit> units = codedStack(*encoder, 3);
  const auto decoder = newDecoder();
  EXPECT_FALSE(decoder->decode(units[1], size_px).ok());
  EXPECT_TRUE(decoder->decode(units[0], size_px).ok());
  EXPECT_FALSE(decoder->decode(units[2], size_px).ok()) << "picture 1 was left out";
  EXPECT_FALSE(decoder->decode(units[1], size_px).ok()) << "an error lasts until the next IDR";
  EXPECT_TRUE(decoder->decode(units[0], size_px).ok());
}

// Libraries before 2.6 then mix memory of two sizes.
TEST(OpenH264, refusesParametersBeforeAPictureThatRefersToOthers) {
  const SizePx size_px{64, 64};
  const auto encoder = encoderOf({.size_px = size_px});
  const std::vector<AccessUnit> units = codedStack(*encoder, 2);
  AccessUnit mixed = {0, 0, 0, 1};
  const NalUnit parameters = nalUnits(units[0]).front();
  mixed.insert(mixed.end(), parameters.bytes.begin(), parameters.bytes.end());
  mixed.insert(mixed.end(), units[1].begin(), units[1].end());
  const auto decoder = newDecoder();
  EXPECT_TRUE(decoder->decode(units[0], size_px).ok());
  const absl::Status refused = decoder->decode(mixed, size_px).status();
  EXPECT_EQ(refused.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(refused.message()), testing::HasSubstr("sequence parameters before"));
}

// The second one would come out as the next.
TEST(OpenH264, refusesTwoPicturesAtOnce) {
  const SizePx size_px{64, 64};
  const auto encoder = encoderOf({.size_px = size_px});
  const AccessUnit first = coded(*encoder, SamplePicture::flat(size_px, 20, 90, 90), {});
  const AccessUnit second = coded(*encoder, SamplePicture::flat(size_px, 200, 90, 90), {});
  AccessUnit both = first;
  both.insert(both.end(), second.begin(), second.end());
  const auto decoder = newDecoder();
  EXPECT_FALSE(decoder->decode(both, size_px).ok());
  const auto next = decoder->decode(first, size_px);
  ASSERT_TRUE(next.ok()) << next.status();
  EXPECT_NEAR(next->y[0], 20, 1);
}

// A stream may say that its decoder has to keep 16.
TEST(OpenH264, refusesStreamsThatKeepManyPictures) {
  // Baseline, level 1.0: numbers 0 (id), 0 (frame number), 2 (order), then the count of references,
  // no gaps, 0 and 0 (16x16 px), whole frames, no cropping, no further facts.
  const AccessUnit four = {0, 0, 1, 0x67, 66, 0xC0, 10, 0xD9, 0x5E, 0x40, 0, 0, 1, 0x65, 0x88};
  const AccessUnit five = {0, 0, 1, 0x67, 66, 0xC0, 10, 0xD9, 0x9E, 0x40, 0, 0, 1, 0x65, 0x88};
  EXPECT_THAT(std::string(newDecoder()->decode(five, {16, 16}).status().message()),
              testing::HasSubstr("it keeps 5 pictures; accepted are up to 4"));
  EXPECT_THAT(std::string(newDecoder()->decode(four, {16, 16}).status().message()),
              testing::HasSubstr("damaged"));
}

TEST(OpenH264, refusesPicturesOfAnotherSizeBeforeItTakesMemory) {
  const auto encoder = encoderOf({.size_px = {4096, 2176}});
  const AccessUnit unit = codedStack(*encoder, 1).front();
  const auto refused = newDecoder()->decode(unit, {64, 64});
  EXPECT_EQ(refused.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(refused.status().message()),
              testing::HasSubstr("pictures of 4096x2176 px; expected are 64x64 px"));
}

TEST(OpenH264, refusesDamagedPicturesOrDecodesThemInFull) {
  const SizePx size_px{64, 64};
  const auto encoder = encoderOf({.size_px = size_px});
  const AccessUnit whole = codedStack(*encoder, 1).front();
  const auto decoder = newDecoder();
  for (size_t size_bytes = 0; size_bytes + 8 < whole.size(); size_bytes += 7) {
    EXPECT_FALSE(decoder->decode(std::span(whole).first(size_bytes), size_px).ok()) << size_bytes;
  }
  for (size_t at = 0; at < whole.size(); ++at) {
    AccessUnit spoilt = whole;
    spoilt[at] ^= 0x55;
    const auto picture = decoder->decode(spoilt, size_px);
    EXPECT_TRUE(!picture.ok() || picture->size_px == size_px);
  }
  EXPECT_TRUE(decoder->decode(whole, size_px).ok()) << "damage before it does no harm";
}

}  // namespace
}  // namespace viewloom::test::openh264_test
