// SPDX-License-Identifier: Apache-2.0
#include "rpc/atlas_messages.h"

#include <gtest/gtest.h>

#include <grpcpp/support/slice.h>

#include <vector>

#include "rpc/wire_message.h"
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
  EXPECT_TRUE(mergeMessage(bytes, response).ok());
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
  AtlasMessages messages(std::move(atlas));
  std::vector<grpc::ByteBuffer> written;
  while (!messages.done()) written.push_back(messages.next());
  messages = AtlasMessages(nullptr);
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
