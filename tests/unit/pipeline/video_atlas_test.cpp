// SPDX-License-Identifier: Apache-2.0
#include "pipeline/video_atlas.h"

#include <thread>

#include <gtest/gtest.h>

#include "unit/encode/picture.h"
#include "video/annex_b.h"
#include "video/openh264_decoder.h"

namespace viewloom::test::video_atlas_test {
namespace {

constexpr SizePx kPicture_px = {64, 48};
const VideoStack kStack = {.view_count = 3, .picture_count = 3, .cell_px = kPicture_px};

class VideoAtlasTest : public testing::Test {
 protected:
  bool put(uint32_t picture, uint32_t row, uint32_t row_count) {
    return atlas_.put(picture, Picture(kPicture_px, picture + 1).band(row, row_count), planes_);
  }
  CodedPicture codeNext() {
    absl::StatusOr<CodedPicture> coded = atlas_.codeNext(encoders_, bytes_);
    EXPECT_TRUE(coded.ok()) << coded.status();
    return coded.ok() ? *std::move(coded) : CodedPicture{};
  }

  BytePool planes_{8};
  BytePool bytes_{8};
  VideoEncoders encoders_{1};
  VideoAtlas atlas_{kStack, 24};
};

TEST_F(VideoAtlasTest, codesAPictureOnceAllItsRowsAreThere) {
  EXPECT_EQ(atlas_.pictureCount(), 3u);
  EXPECT_FALSE(put(0, 32, 16));
  EXPECT_TRUE(put(0, 0, 32));
  const CodedPicture first = codeNext();
  EXPECT_EQ(first.picture, 0u);
  EXPECT_FALSE(first.is_next_ready);
  EXPECT_EQ(nalUnits(*first.bytes).back().type(), NalType::kIdrSlice);
}

TEST_F(VideoAtlasTest, codesPicturesInTheirOrder) {
  EXPECT_FALSE(put(2, 0, 48));
  EXPECT_FALSE(put(1, 0, 48));
  EXPECT_TRUE(put(0, 0, 48));
  auto decoder = OpenH264Decoder::make();
  ASSERT_TRUE(decoder.ok());
  for (uint32_t picture = 0; picture < 3; ++picture) {
    const CodedPicture coded = codeNext();
    EXPECT_EQ(coded.picture, picture);
    EXPECT_EQ(coded.is_next_ready, picture < 2);
    EXPECT_TRUE((*decoder)->decode(*coded.bytes, kPicture_px).ok());
  }
}

TEST_F(VideoAtlasTest, asksForOneCoderAtATime) {
  EXPECT_TRUE(put(0, 0, 48));
  EXPECT_FALSE(put(1, 0, 48)) << "whoever codes picture 0 goes on with it";
  EXPECT_TRUE(codeNext().is_next_ready);
  EXPECT_FALSE(put(2, 0, 32));
  EXPECT_FALSE(codeNext().is_next_ready);
  EXPECT_TRUE(put(2, 32, 16));
  EXPECT_FALSE(codeNext().is_next_ready);
}

TEST_F(VideoAtlasTest, makesTheSameBytesWithAnEncoderThatCodedAnotherAtlas) {
  const auto bytesOf = [&] {
    VideoAtlas atlas(kStack, 30);
    std::vector<std::vector<uint8_t>> units;
    for (uint32_t picture = 0; picture < 3; ++picture) {
      EXPECT_TRUE(atlas.put(picture, Picture(kPicture_px, picture).band(0, 48), planes_));
      const auto coded = atlas.codeNext(encoders_, bytes_);
      EXPECT_TRUE(coded.ok()) << coded.status();
      units.push_back(*coded->bytes);
    }
    return units;
  };
  const auto first = bytesOf();
  const auto second = bytesOf();
  // The first pictures differ in idr_pic_id, as H.264 asks of neighbours.
  EXPECT_EQ(first[1], second[1]);
  EXPECT_EQ(first[2], second[2]);
}

TEST_F(VideoAtlasTest, countsTheThreadsThatHelp) {
  EXPECT_TRUE(put(0, 0, 48));
  EXPECT_EQ(codeNext().help_ns, 0) << "no picture of 48 rows is cut";
  const SizePx tall_px{64, 256};
  VideoEncoders of_two(2);
  VideoAtlas atlas({.view_count = 1, .picture_count = 1, .cell_px = tall_px}, 24);
  EXPECT_TRUE(atlas.put(0, Picture(tall_px, 1).band(0, 256), planes_));
  const auto coded = atlas.codeNext(of_two, bytes_);
  ASSERT_TRUE(coded.ok()) << coded.status();
  EXPECT_GT(coded->help_ns, 0);
}

TEST_F(VideoAtlasTest, takesRowsFromSeveralThreads) {
  std::atomic<int> told_count = 0;
  {
    std::vector<std::jthread> threads;
    for (uint32_t i = 0; i < 3; ++i) {
      threads.emplace_back([&, i] { told_count += put(0, 16 * i, 16) ? 1 : 0; });
    }
  }
  EXPECT_EQ(told_count, 1);
  EXPECT_EQ(codeNext().picture, 0u);
}

}  // namespace
}  // namespace viewloom::test::video_atlas_test
