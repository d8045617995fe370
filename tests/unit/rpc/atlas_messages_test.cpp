// SPDX-License-Identifier: Apache-2.0
#include "rpc/atlas_messages.h"

#include <gtest/gtest.h>

#include <grpcpp/support/slice.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "messages/wire_message.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom::atlas_messages_test {
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

AtlasMessages messagesOf(AtlasPtr whole) {
  return AtlasMessages(std::make_shared<GrowingAtlas>(std::move(whole)));
}

// The next, of an atlas that has one.
v1::StreamAtlasesResponse next(AtlasMessages& messages) {
  EXPECT_TRUE(messages.isReady());
  auto bytes = messages.next({});
  EXPECT_TRUE(bytes.has_value());
  return bytes ? parsed(*std::move(bytes)) : v1::StreamAtlasesResponse();
}

TEST(AtlasMessages, comeAsHeaderPiecesAndEnd) {
  const auto atlas = atlasOfTwoBands();
  atlas->times.trace_ns = 5;
  atlas->times.retime_ns = 6;
  atlas->coverage = {.hit = 3, .hidden = 1};
  AtlasMessages messages = messagesOf(atlas);
  const auto header = next(messages);
  ASSERT_TRUE(header.has_header());
  EXPECT_EQ(header.header().sequence(), 300u);
  EXPECT_EQ(header.header().frame_number(), 12u);
  EXPECT_EQ(header.header().band_count(), 2u);
  EXPECT_FALSE(header.header().has_depth_budget());
  const auto first = next(messages);
  EXPECT_EQ(first.band().data().size(), 3u);
  EXPECT_TRUE(first.band().last_piece());
  for (const size_t offset : {size_t{0}, kPieceBytesMax, 2 * kPieceBytesMax}) {
    const auto piece = next(messages);
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
  const v1::AtlasEnd end = next(messages).end();
  EXPECT_EQ(end.sequence(), 300u);
  EXPECT_EQ(end.times().trace_ns(), 5);
  EXPECT_EQ(end.times().retime_ns(), 6);
  EXPECT_EQ(end.coverage().hit(), 0.75);
  EXPECT_FALSE(end.has_reflections());
  EXPECT_TRUE(messages.done());
  EXPECT_TRUE(messages.wasWhole());
}

// A begun atlas with this many bands of 128 rows for each plane, without bytes.
EncodedAtlas begunOf(std::vector<AtlasPlane> planes, uint32_t band_count, BandEncoding encoding) {
  EncodedAtlas atlas;
  atlas.sequence = 4;
  for (const AtlasPlane plane : planes) {
    for (uint32_t band = 0; band < band_count; ++band) {
      atlas.bands.push_back({.plane = plane,
                             .first_row = 128 * band,
                             .row_count = 128,
                             .encoding = encoding,
                             .bytes = nullptr});
    }
  }
  return atlas;
}

AtlasPtr wholeOf(EncodedAtlas atlas, size_t band_bytes) {
  for (size_t i = 0; i < atlas.bands.size(); ++i) atlas.bands[i].bytes = bytesOf(band_bytes + i);
  return std::make_shared<EncodedAtlas>(std::move(atlas));
}

// The pieces of all bands; as many of these are ended as the header says.
std::vector<v1::Band> piecesOf(AtlasMessages messages) {
  const uint32_t count = next(messages).header().band_count();
  std::vector<v1::Band> pieces;
  uint32_t ended_count = 0;
  while (!messages.done()) {
    const auto message = next(messages);
    if (!message.has_band()) continue;
    pieces.push_back(message.band());
    ended_count += message.band().last_piece();
  }
  EXPECT_EQ(ended_count, count);
  return pieces;
}

TEST(AtlasMessages, joinTheBandsOfAFile) {
  const AtlasPtr atlas =
      wholeOf(begunOf({AtlasPlane::kColor}, 3, BandEncoding::kJpeg), kPieceBytesMax / 2 - 1);
  const std::vector<v1::Band> pieces = piecesOf(messagesOf(atlas));
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(pieces[0].data().size(), kPieceBytesMax - 1) << "as many bands as a message holds";
  std::string file;
  std::string joined;
  for (const v1::Band& piece : pieces) {
    EXPECT_EQ(piece.first_row(), 0u);
    EXPECT_EQ(piece.row_count(), 384u);
    EXPECT_EQ(piece.offset_bytes(), joined.size());
    joined += piece.data();
  }
  for (const EncodedBand& band : atlas->bands) file.append(band.bytes->begin(), band.bytes->end());
  EXPECT_EQ(joined, file);
}

TEST(AtlasMessages, letPlanesTakeTurnsFromTheTop) {
  const AtlasPtr atlas =
      wholeOf(begunOf({AtlasPlane::kRed, AtlasPlane::kGreen}, 16, BandEncoding::kJpegPlanes), 1000);
  const std::vector<v1::Band> pieces = piecesOf(messagesOf(atlas));
  ASSERT_EQ(pieces.size(), 16u);
  for (uint32_t i = 0; i < 16; ++i) {
    EXPECT_EQ(pieces[i].plane(), i % 2 == 0 ? v1::ATLAS_PLANE_RED : v1::ATLAS_PLANE_GREEN);
    EXPECT_EQ(pieces[i].first_row(), i / 2 * 256);
    EXPECT_EQ(pieces[i].row_count(), 256u);
  }
}

TEST(AtlasMessages, leaveOtherBandsByThemselves) {
  for (const BandEncoding encoding : {BandEncoding::kZstd, BandEncoding::kRaw}) {
    const AtlasPtr atlas = wholeOf(begunOf({AtlasPlane::kColor}, 4, encoding), 1000);
    EXPECT_EQ(piecesOf(messagesOf(atlas)).size(), 4u);
  }
}

TEST(AtlasMessages, keepImagesApart) {
  EncodedAtlas atlas = begunOf({AtlasPlane::kColor}, 4, BandEncoding::kJpeg);
  for (size_t i = 2; i < 4; ++i) atlas.bands[i].image_index = 1;
  const std::vector<v1::Band> pieces = piecesOf(messagesOf(wholeOf(std::move(atlas), 1000)));
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(pieces[1].image_index(), 1u);
}

TEST(AtlasMessages, leaveWhenTheyArePacked) {
  const auto growing =
      std::make_shared<GrowingAtlas>(begunOf({AtlasPlane::kColor}, 4, BandEncoding::kJpeg));
  AtlasMessages messages(growing);
  EXPECT_FALSE(messages.mayBegin({}));
  growing->put(1, bytesOf(10));
  EXPECT_FALSE(messages.mayBegin({})) << "the first is not there";
  growing->put(0, bytesOf(10));
  EXPECT_TRUE(messages.mayBegin({}));
  EXPECT_EQ(next(messages).header().band_count(), 1u);
  EXPECT_EQ(next(messages).band().data().size(), 20u) << "the first piece waits for nothing";
  EXPECT_FALSE(messages.isReady());
  EXPECT_EQ(messages.next({}), std::nullopt);
  growing->put(2, bytesOf(kPieceBytesMin - 1));
  EXPECT_EQ(messages.next({}), std::nullopt) << "small pieces cost more than they bring";
  growing->put(3, bytesOf(1));
  const v1::Band last = next(messages).band();
  EXPECT_EQ(last.offset_bytes(), 20u);
  EXPECT_TRUE(last.last_piece());
  EXPECT_EQ(messages.next({}), std::nullopt) << "its outcome is not known";
  growing->complete({.coverage = {.hit = 1}});
  EXPECT_EQ(next(messages).end().coverage().hit(), 1);
  EXPECT_TRUE(messages.wasWhole());
}

TEST(AtlasMessages, areLargerForManyViewers) {
  const auto growing =
      std::make_shared<GrowingAtlas>(begunOf({AtlasPlane::kColor}, 3, BandEncoding::kJpeg));
  AtlasMessages for_two(growing, 2);
  AtlasMessages for_many(growing, 1000);
  growing->put(0, bytesOf(2 * kPieceBytesMin - 1));
  EXPECT_FALSE(for_two.mayBegin({}));
  growing->put(1, bytesOf(1));
  EXPECT_TRUE(for_two.mayBegin({}));
  EXPECT_FALSE(for_many.mayBegin({})) << "as if the atlas were sent whole";
  growing->put(2, bytesOf(1));
  EXPECT_TRUE(for_many.mayBegin({})) << "nothing more comes";
}

TEST(AtlasMessages, endWithTheAtlasThatIsAbandoned) {
  const auto growing =
      std::make_shared<GrowingAtlas>(begunOf({AtlasPlane::kColor}, 2, BandEncoding::kRaw));
  growing->put(0, bytesOf(10));
  AtlasMessages messages(growing);
  next(messages);
  next(messages);
  growing->abandon();
  EXPECT_EQ(next(messages).abandoned().sequence(), 4u);
  EXPECT_TRUE(messages.done());
  EXPECT_FALSE(messages.wasWhole());
}

TEST(AtlasMessages, giveUpOnlyWhatIsNotWhole) {
  const auto growing =
      std::make_shared<GrowingAtlas>(begunOf({AtlasPlane::kColor}, 1, BandEncoding::kRaw));
  AtlasMessages given_up(growing);
  next(given_up);
  given_up.giveUp();
  EXPECT_TRUE(next(given_up).has_abandoned());
  growing->put(0, bytesOf(10));
  growing->complete({});
  AtlasMessages whole(growing);
  next(whole);
  whole.giveUp();
  EXPECT_TRUE(next(whole).has_band());
  EXPECT_TRUE(next(whole).has_end());
}

// The bytes a piece is made of by hand are those that protobuf itself writes.
TEST(AtlasMessages, areWhatProtobufWrites) {
  AtlasMessages messages = messagesOf(atlasOfTwoBands());
  while (!messages.done()) {
    const grpc::ByteBuffer bytes = messages.next({}).value();
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
    AtlasMessages messages = messagesOf(std::move(atlas));
    while (!messages.done()) written.push_back(messages.next({}).value());
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
}  // namespace viewloom::atlas_messages_test
