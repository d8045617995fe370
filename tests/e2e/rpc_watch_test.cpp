// SPDX-License-Identifier: Apache-2.0
// Promises to clients of StreamAtlases.
#include <gtest/gtest.h>

#include "e2e/test_publisher.h"
#include "e2e/test_server.h"
#include "e2e/test_watcher.h"

namespace viewloom::rpc_watch_test {
namespace {

void expectBytesOf(const ReceivedAtlas& atlas) {
  for (const auto& [first_row, bytes] : atlas.color_bands) {
    size_t wrong_count = 0;
    for (size_t i = 0; i < bytes.size(); ++i) {
      const auto byte = static_cast<uint8_t>(bytes[i]);
      wrong_count += byte != expectedByte(atlas.header.frame_number(), first_row, i);
    }
    EXPECT_EQ(wrong_count, 0u) << "in the band at row " << first_row;
  }
}

v1::StreamAtlasesRequest changeTo(const v1::OpenDisplay& open) {
  v1::StreamAtlasesRequest request;
  *request.mutable_change()->mutable_display() = open.display();
  return request;
}

TEST(StreamAtlases, deliversEveryAtlasWithItsTruth) {
  TestServer server;
  TestPublisher publisher(server.connect(), "scene");
  ASSERT_TRUE(publisher.sendFrame(5));
  ASSERT_TRUE(publisher.readReport().has_value());
  TestWatcher watcher(server.connect(), smallQuilt("scene"));
  watcher.halfClose();
  for (uint64_t number = 5; number < 9; ++number) {
    const auto atlas = watcher.readAtlas();
    ASSERT_TRUE(atlas.has_value());
    EXPECT_EQ(atlas->header.frame_number(), number);
    EXPECT_EQ(atlas->header.sequence(), number - 4);
    EXPECT_EQ(atlas->header.capture_time_ns(), static_cast<int64_t>(number) * 1000);
    EXPECT_EQ(atlas->end.coverage().hit(), 0.75);
    EXPECT_EQ(atlas->end.coverage().hidden(), 0.25);
    EXPECT_EQ(atlas->layout.has_value(), number == 5) << "a layout comes when it is new";
    expectBytesOf(*atlas);
    ASSERT_TRUE(publisher.sendFrame(number + 1));
    ASSERT_EQ(publisher.readReport()->outcome(), v1::FRAME_OUTCOME_TRACED);
  }
}

TEST(StreamAtlases, saysHowTheViewsLie) {
  TestServer server;
  TestPublisher publisher(server.connect(), "scene");
  publisher.sendFrame(1);
  TestWatcher watcher(server.connect(), smallQuilt("scene"));
  const auto atlas = watcher.readAtlas();
  ASSERT_TRUE(atlas.has_value() && atlas->layout.has_value());
  EXPECT_EQ(atlas->layout->size().width(), 16u);
  EXPECT_EQ(atlas->layout->tile_size().width(), 8u);
  EXPECT_EQ(atlas->layout->order(), v1::TILE_ORDER_BOTTOM_LEFT);
  EXPECT_EQ(atlas->layout->views_size(), 2);
  EXPECT_EQ(atlas->layout->encoding().color(), v1::BAND_ENCODING_RAW);
  EXPECT_EQ(atlas->layout->encoding().jpeg_quality(), 85u);
  EXPECT_EQ(atlas->layout->suffix(), "_qs2x1a1");
}

TEST(StreamAtlases, cutsLargeBandsIntoPieces) {
  TestServer server;
  TestPublisher publisher(server.connect(), "scene");
  publisher.sendFrame(1);
  v1::OpenDisplay open = smallQuilt("scene");
  open.mutable_display()->mutable_quilt()->mutable_size()->set_width(8192);
  open.mutable_display()->mutable_quilt()->mutable_size()->set_height(200);
  open.set_count(1);
  TestWatcher watcher(server.connect(), open);
  const auto atlas = watcher.readAtlas();
  ASSERT_TRUE(atlas.has_value());
  EXPECT_EQ(atlas->color_bands.size(), 2u);
  EXPECT_EQ(atlas->piece_count, 5u) << "3 MiB of 128 rows in 3, the other 72 rows in 2";
  expectBytesOf(*atlas);
}

TEST(StreamAtlases, endsWhenTheCountIsReached) {
  TestServer server;
  TestPublisher publisher(server.connect(), "scene");
  publisher.sendFrame(1);
  v1::OpenDisplay open = smallQuilt("scene");
  open.set_count(1);
  TestWatcher watcher(server.connect(), open);
  EXPECT_TRUE(watcher.readAtlas().has_value());
  EXPECT_FALSE(watcher.readAtlas().has_value());
  EXPECT_TRUE(watcher.finish().ok());
  EXPECT_EQ(server.broadcaster().subscriberCount("scene"), 0u);
}

TEST(StreamAtlases, givesAReaderThatComesBackTheNewestAtlasAndTheGap) {
  TestServer server;
  TestPublisher publisher(server.connect(), "scene");
  publisher.sendFrame(1);
  publisher.readReport();
  v1::OpenDisplay open = smallQuilt("scene");
  // 3 MiB an atlas: more than connection and client take in unread.
  open.mutable_display()->mutable_quilt()->mutable_size()->set_width(8192);
  open.mutable_display()->mutable_quilt()->mutable_size()->set_height(128);
  TestWatcher slow(server.connect(), open);
  ASSERT_EQ(slow.readAtlas()->header.frame_number(), 1u);
  constexpr uint64_t kLastNumber = 30;
  for (uint64_t number = 2; number <= kLastNumber; ++number) {
    ASSERT_TRUE(publisher.sendFrame(number));
    ASSERT_EQ(publisher.readReport()->outcome(), v1::FRAME_OUTCOME_TRACED);
  }
  uint64_t sequence = 1;
  uint64_t skipped_count = 0;
  while (sequence < kLastNumber) {
    const auto atlas = slow.readAtlas();
    ASSERT_TRUE(atlas.has_value());
    EXPECT_EQ(atlas->header.sequence(), sequence + atlas->skipped_count + 1);
    expectBytesOf(*atlas);
    sequence = atlas->header.sequence();
    skipped_count += atlas->skipped_count;
  }
  EXPECT_GT(skipped_count, 0u);
  EXPECT_EQ(server.metrics().replaced[HandOver::kGrpc].value(), static_cast<double>(skipped_count));
}

TEST(StreamAtlases, losesNothingBecauseOfOneThatNeverReads) {
  TestServer server;
  TestPublisher publisher(server.connect(), "scene");
  publisher.sendFrame(1);
  publisher.readReport();
  TestWatcher fast(server.connect(), smallQuilt("scene"));
  v1::OpenDisplay large = smallQuilt("scene");
  large.mutable_display()->mutable_quilt()->mutable_size()->set_width(8192);
  large.mutable_display()->mutable_quilt()->mutable_size()->set_height(128);
  TestWatcher never(server.connect(), large);
  TestWatcher also_never(server.connect(), smallQuilt("scene"));
  ASSERT_EQ(fast.readAtlas()->header.sequence(), 1u);
  for (uint64_t number = 2; number <= 40; ++number) {
    ASSERT_TRUE(publisher.sendFrame(number));
    ASSERT_TRUE(publisher.readReport().has_value());
    const auto atlas = fast.readAtlas();
    ASSERT_TRUE(atlas.has_value());
    EXPECT_EQ(atlas->header.sequence(), number);
    EXPECT_EQ(atlas->skipped_count, 0u);
  }
}

TEST(StreamAtlases, announcesAChangedDisplayByItsLayout) {
  TestServer server;
  TestPublisher publisher(server.connect(), "scene");
  publisher.sendFrame(1);
  TestWatcher watcher(server.connect(), smallQuilt("scene"));
  ASSERT_EQ(watcher.readAtlas()->color_bands.at(0).size(), 16u * 8 * 3);
  v1::OpenDisplay wider = smallQuilt("scene");
  wider.mutable_display()->mutable_quilt()->mutable_size()->set_width(32);
  ASSERT_TRUE(watcher.send(changeTo(wider)));
  const auto atlas = watcher.readAtlas();
  ASSERT_TRUE(atlas.has_value() && atlas->layout.has_value());
  EXPECT_EQ(atlas->layout->size().width(), 32u);
  EXPECT_EQ(atlas->header.sequence(), 1u) << "a display counts its own atlases";
  EXPECT_EQ(atlas->color_bands.at(0).size(), 32u * 8 * 3) << "the encoding stays";
  EXPECT_EQ(server.broadcaster().displays("scene").size(), 1u) << "the old display is left";
}

TEST(StreamAtlases, countsWhatClientsSayTheyHaveShown) {
  TestServer server;
  TestPublisher publisher(server.connect(), "scene");
  publisher.sendFrame(1);
  TestWatcher watcher(server.connect(), smallQuilt("scene"));
  ASSERT_TRUE(watcher.readAtlas().has_value());
  v1::StreamAtlasesRequest request;
  request.mutable_presented()->set_sequence(1);
  ASSERT_TRUE(watcher.send(request));
  ASSERT_TRUE(watcher.send(changeTo(smallQuilt("scene"))));
  ASSERT_TRUE(
      watcher.readAtlas().has_value());  // the change was handled, so what came before it too
  EXPECT_EQ(server.metrics().atlases_presented.value(), 1);
}

TEST(StreamAtlases, waitsForAStreamWhenAsked) {
  TestServer server;
  v1::OpenDisplay open = smallQuilt("later");
  open.set_wait_for_stream(true);
  TestWatcher watcher(server.connect(), open);
  TestPublisher publisher(server.connect(), "later");
  publisher.sendFrame(1);
  EXPECT_EQ(watcher.readAtlas()->header.frame_number(), 1u);
}

TEST(StreamAtlases, staysWhenThePublisherLeavesAndComesBack) {
  TestServer server;
  std::optional<TestPublisher> publisher;
  publisher.emplace(server.connect(), "scene");
  publisher->sendFrame(7);
  TestWatcher watcher(server.connect(), smallQuilt("scene"));
  ASSERT_EQ(watcher.readAtlas()->header.frame_number(), 7u);
  publisher->halfClose();
  EXPECT_TRUE(publisher->finish().ok());
  publisher.emplace(server.connect(), "scene");
  publisher->sendFrame(1);
  EXPECT_EQ(watcher.readAtlas()->header.frame_number(), 1u);
}

TEST(StreamAtlases, endsWholeWhenTheServerDrains) {
  std::optional<TestServer> server(std::in_place);
  TestPublisher publisher(server->connect(), "scene");
  publisher.sendFrame(1);
  TestWatcher plain(server->connect(), smallQuilt("scene"));
  TestWatcher closed(server->connect(), smallQuilt("scene"));
  closed.halfClose();
  for (uint64_t number = 2; number < 20; ++number) {  // the half-close is long read by then
    ASSERT_TRUE(plain.readAtlas().has_value());
    ASSERT_TRUE(closed.readAtlas().has_value());
    ASSERT_TRUE(publisher.sendFrame(number));
    ASSERT_TRUE(publisher.readReport().has_value());
  }
  server.reset();
  EXPECT_EQ(plain.finish().error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_TRUE(closed.finish().ok());
  EXPECT_EQ(publisher.finish().error_code(), grpc::StatusCode::UNAVAILABLE);
}

}  // namespace
}  // namespace viewloom::rpc_watch_test
