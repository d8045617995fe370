// SPDX-License-Identifier: Apache-2.0
#include "rpc/atlas_messages.h"

#include <gtest/gtest.h>

#include <grpcpp/support/slice.h>

#include <algorithm>
#include <string>
#include <vector>

#include "messages/wire_message.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom {
namespace {

constexpr size_t kLargeBytes = (size_t{2} << 20) + 5;

SharedBytes bytesOf(size_t count) {
  auto bytes = std::make_shared<std::vector<uint8_t>>(count);
  for (size_t i = 0; i < count; ++i) (*bytes)[i] = static_cast<uint8_t>(i * 7 + i / 251);
  return bytes;
}

std::shared_ptr<EncodedAtlas> atlasOfTwoBands() {
  auto atlas = std::make_shared<EncodedAtlas>();
  atlas->sequence = 300;
  atlas->frame_number = 12;
  atlas->bands = {{.bytes = bytesOf(3)},
                  {.image_index = 2,
                   .plane = AtlasPlane::kMask,
                   .first_row = 128,
                   .row_count = 64,
                   .encoding = BandEncoding::kZstd,
                   .bytes = bytesOf(kLargeBytes)}};
  return atlas;
}

v1::StreamAtlasesResponse parsed(grpc::ByteBuffer bytes) {
  v1::StreamAtlasesResponse response;
  EXPECT_TRUE(parseMessage(bytes, response).ok());
  return response;
}

TEST(AtlasMessages, comeAsHeaderPiecesAndEnd) {
  AtlasMessages messages(atlasOfTwoBands());
  const auto header = parsed(messages.next());
  ASSERT_TRUE(header.has_header());
  EXPECT_EQ(header.header().sequence(), 300u);
  EXPECT_EQ(header.header().frame_number(), 12u);
  EXPECT_EQ(header.header().band_count(), 2u);
  EXPECT_FALSE(header.header().has_depth_budget());
  const auto first = parsed(messages.next());
  EXPECT_EQ(first.band().data().size(), 3u);
  EXPECT_TRUE(first.band().last_piece());
  for (const size_t offset : {size_t{0}, kPieceBytesMax, 2 * kPieceBytesMax}) {
    const auto piece = parsed(messages.next());
    ASSERT_TRUE(piece.has_band());
    EXPECT_EQ(piece.band().sequence(), 300u);
    EXPECT_EQ(piece.band().image_index(), 2u);
    EXPECT_EQ(piece.band().plane(), v1::ATLAS_PLANE_MASK);
    EXPECT_EQ(piece.band().first_row(), 128u);
    EXPECT_EQ(piece.band().row_count(), 64u);
    EXPECT_EQ(piece.band().encoding(), v1::BAND_ENCODING_ZSTD);
    EXPECT_EQ(piece.band().offset_bytes(), offset);
    EXPECT_EQ(piece.band().last_piece(), offset == 2 * kPieceBytesMax);
    EXPECT_EQ(piece.band().data().size(), std::min(kPieceBytesMax, kLargeBytes - offset));
  }
  EXPECT_FALSE(messages.done());
  EXPECT_EQ(parsed(messages.next()).end().sequence(), 300u);
  EXPECT_TRUE(messages.done());
}

// Three bands that adjoin, a fourth of another plane.
std::shared_ptr<EncodedAtlas> atlasOfStrip(BandEncoding encoding, size_t band_bytes) {
  auto atlas = std::make_shared<EncodedAtlas>();
  for (uint32_t row = 0; row < 300; row += 128) {
    atlas->bands.push_back({.plane = AtlasPlane::kRed,
                            .first_row = row,
                            .row_count = std::min(128U, 300 - row),
                            .encoding = encoding,
                            .bytes = bytesOf(band_bytes + row)});
  }
  atlas->bands.push_back(
      {.plane = AtlasPlane::kGreen, .row_count = 128, .encoding = encoding, .bytes = bytesOf(7)});
  return atlas;
}

std::vector<v1::Band> bandsOf(AtlasMessages messages) {
  const uint32_t count = parsed(messages.next()).header().band_count();
  std::vector<v1::Band> bands;
  while (!messages.done()) {
    const auto message = parsed(messages.next());
    if (message.has_band()) bands.push_back(message.band());
  }
  EXPECT_EQ(bands.size(), count);
  return bands;
}

TEST(AtlasMessages, joinBandsThatAreOneImagesTogether) {
  for (const BandEncoding encoding :
       {BandEncoding::kJpeg, BandEncoding::kJpegPlanes, BandEncoding::kRaw}) {
    const auto atlas = atlasOfStrip(encoding, 1000);
    const std::vector<v1::Band> bands = bandsOf(AtlasMessages(atlas));
    ASSERT_EQ(bands.size(), 2u) << "the other plane's stays by itself";
    EXPECT_EQ(bands[0].first_row(), 0u);
    EXPECT_EQ(bands[0].row_count(), 300u);
    EXPECT_TRUE(bands[0].last_piece());
    std::string joined;
    for (size_t i = 0; i < 3; ++i) {
      joined.append(atlas->bands[i].bytes->begin(), atlas->bands[i].bytes->end());
    }
    EXPECT_EQ(bands[0].data(), joined);
    EXPECT_EQ(bands[1].plane(), v1::ATLAS_PLANE_GREEN);
    EXPECT_EQ(bands[1].data().size(), 7u);
  }
}

TEST(AtlasMessages, leaveFramesOfZstdByThemselves) {
  EXPECT_EQ(bandsOf(AtlasMessages(atlasOfStrip(BandEncoding::kZstd, 1000))).size(), 4u);
}

TEST(AtlasMessages, joinNoBandsThatDoNotAdjoinOrAreOfOtherImages) {
  const auto gap = atlasOfStrip(BandEncoding::kJpeg, 1000);
  gap->bands[2].first_row += 8;
  EXPECT_EQ(bandsOf(AtlasMessages(gap)).size(), 3u);
  const auto images = atlasOfStrip(BandEncoding::kJpeg, 1000);
  for (size_t i = 1; i < 3; ++i) images->bands[i].image_index = 1;
  EXPECT_EQ(bandsOf(AtlasMessages(images)).size(), 3u);
}

TEST(AtlasMessages, joinNoMoreThanAMessageHolds) {
  const auto atlas = atlasOfStrip(BandEncoding::kJpeg, (kPieceBytesMax - 128) / 2);
  const std::vector<v1::Band> bands = bandsOf(AtlasMessages(atlas));
  ASSERT_EQ(bands.size(), 3u);
  EXPECT_EQ(bands[0].data().size(), kPieceBytesMax) << "the first two fill it";
  EXPECT_EQ(bands[1].first_row(), 256u);
}

// The bytes a piece is made of by hand are those that protobuf itself writes.
TEST(AtlasMessages, areWhatProtobufWrites) {
  AtlasMessages messages(atlasOfTwoBands());
  while (!messages.done()) {
    const grpc::ByteBuffer bytes = messages.next();
    grpc::Slice whole;
    ASSERT_TRUE(bytes.DumpToSingleSlice(&whole).ok());
    EXPECT_EQ(parsed(bytes).SerializeAsString(), std::string(whole.begin(), whole.end()));
  }
}

TEST(AtlasMessages, shareTheBytesOfTheBandsAndHoldThem) {
  std::shared_ptr<EncodedAtlas> atlas = atlasOfTwoBands();
  const uint8_t* large = atlas->bands[1].bytes->data();
  const std::weak_ptr<const std::vector<uint8_t>> watched = atlas->bands[1].bytes;
  std::vector<grpc::ByteBuffer> written;
  {
    AtlasMessages messages(std::move(atlas));
    while (!messages.done()) written.push_back(messages.next());
  }
  EXPECT_FALSE(watched.expired()) << "a message that is being written holds its band";
  std::vector<grpc::Slice> slices;
  ASSERT_TRUE(written[3].Dump(&slices).ok());  // header, small band, first and second piece
  ASSERT_EQ(slices.size(), 2u);
  EXPECT_EQ(slices[1].begin(), large + kPieceBytesMax);
  slices.clear();
  written.clear();
  EXPECT_TRUE(watched.expired());
}

}  // namespace
}  // namespace viewloom
