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
  EXPECT_EQ(first.place, 0u);
  EXPECT_FALSE(first.is_next_ready);
  EXPECT_EQ(nalUnits(*first.bytes).back().type(), NalType::kIdrSlice);
}

TEST_F(VideoAtlasTest, measuresTheTimeOfAllItsPictures) {
  EXPECT_EQ(atlas_.codingNs(), 0);
  EXPECT_TRUE(put(0, 0, 48));
  codeNext();
  const int64_t first_ns = atlas_.codingNs();
  EXPECT_GT(first_ns, 0);
  EXPECT_TRUE(put(1, 0, 48));
  codeNext();
  EXPECT_GT(atlas_.codingNs(), first_ns);
}

TEST_F(VideoAtlasTest, codesPicturesInTheirOrder) {
  EXPECT_FALSE(put(2, 0, 48));
  EXPECT_FALSE(put(1, 0, 48));
  EXPECT_TRUE(put(0, 0, 48));
  auto decoder = OpenH264Decoder::make();
  ASSERT_TRUE(decoder.ok());
  for (uint32_t picture = 0; picture < 3; ++picture) {
    const CodedPicture coded = codeNext();
    EXPECT_EQ(coded.place, picture);
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

class ChainedVideoTest : public VideoAtlasTest {
 protected:
  // The access units of an atlas, whose pictures are those of `seed`.
  std::vector<std::vector<uint8_t>> code(uint32_t seed, bool is_self_contained, uint32_t qp = 24) {
    VideoAtlas atlas(kStack, 24);
    atlas.begin({.qp = qp, .chain = chain_, .is_self_contained = is_self_contained});
    std::vector<std::vector<uint8_t>> units;
    for (uint32_t picture = 0; picture < 3; ++picture) {
      EXPECT_TRUE(atlas.put(picture, Picture(kPicture_px, seed + picture).band(0, 48), planes_));
      const auto coded = atlas.codeNext(encoders_, bytes_);
      EXPECT_TRUE(coded.ok()) << coded.status();
      units.push_back(*coded->bytes);
    }
    return units;
  }

  const std::shared_ptr<VideoChain> chain_ = std::make_shared<VideoChain>();
};

bool isIdr(const std::vector<uint8_t>& unit) {
  return nalUnits(unit).back().type() == NalType::kIdrSlice;
}

TEST_F(ChainedVideoTest, makesOneStreamOfAllAtlases) {
  const auto decoder = *OpenH264Decoder::make();
  for (const bool is_self_contained : {true, false, false, true, false}) {
    const auto units = code(1, is_self_contained);
    for (size_t place = 0; place < 3; ++place) {
      EXPECT_EQ(isIdr(units[place]), is_self_contained && place == 0);
      EXPECT_TRUE(decoder->decode(units[place], kPicture_px).ok());
    }
  }
}

// The last picture of the first atlas stands: noise, which nothing else predicts.
TEST_F(ChainedVideoTest, takesFewBytesOfAPictureThatComesTwice) {
  const size_t alone = code(1, true, kVideoQpMin)[2].size();
  EXPECT_LT(code(3, false, kVideoQpMin)[0].size(), alone / 4);
}

TEST_F(ChainedVideoTest, changesTheQuantisationBetweenAtlases) {
  code(1, true, 40);
  EXPECT_FALSE(isIdr(code(1, false, 22)[0]));
  EXPECT_LT(code(5, false, 44)[0].size(), code(9, false, kVideoQpMin)[0].size());
}

// Fine video has one thread, coarse video several (VideoEncoders): pictures of another encoder
// refer to none, and readers decode on.
TEST(ChainedVideo, goesOnWhereTheQuantisationTakesAnotherEncoder) {
  const SizePx tall_px{64, 256};
  VideoEncoders of_two(2);
  BytePool pool(8);
  const auto chain = std::make_shared<VideoChain>();
  const auto decoder = *OpenH264Decoder::make();
  std::vector<bool> are_idr;
  for (const uint32_t qp : {30u, 24u, 23u, 20u, 24u, 51u}) {
    VideoAtlas atlas({.view_count = 1, .picture_count = 1, .cell_px = tall_px}, 24);
    atlas.begin({.qp = qp, .chain = chain, .is_self_contained = are_idr.empty()});
    EXPECT_TRUE(atlas.put(0, Picture(tall_px, 1).band(0, 256), pool));
    const auto coded = atlas.codeNext(of_two, pool);
    ASSERT_TRUE(coded.ok()) << coded.status();
    EXPECT_TRUE(decoder->decode(*coded->bytes, tall_px).ok());
    are_idr.push_back(isIdr(*coded->bytes));
  }
  EXPECT_EQ(are_idr, (std::vector<bool>{true, false, true, false, true, false}));
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
  EXPECT_EQ(codeNext().place, 0u);
}

}  // namespace
}  // namespace viewloom::test::video_atlas_test
