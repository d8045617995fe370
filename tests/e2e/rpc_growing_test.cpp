// SPDX-License-Identifier: Apache-2.0
// Promises to clients of StreamAtlases about atlases that are sent while being made.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "e2e/test_publisher.h"
#include "e2e/test_server.h"
#include "e2e/test_watcher.h"

namespace viewloom::rpc_growing_test {
namespace {

using Message = v1::StreamAtlasesResponse;

// Atlas 1 is whole, of two bands; later ones are made here, band by band.
class GrowingAtlases : public testing::Test {
 protected:
  GrowingAtlases() {
    v1::QuiltDisplay& quilt = *open_.mutable_display()->mutable_quilt();
    quilt.mutable_size()->set_height(200);
    publisher_.sendFrame(1);
    publisher_.readReport();
    watcher_.emplace(server_.connect(), open_);
    EXPECT_EQ(watcher_->readAtlas()->header.sequence(), 1u);
  }

  uint64_t displayId() { return server_.broadcaster().displays("scene").front()->id; }

  GrowingAtlasPtr begin() {
    EncodedAtlas atlas = *server_.broadcaster().newest(displayId());
    atlas.sequence = server_.broadcaster().nextSequence(atlas.display_id);
    for (EncodedBand& band : atlas.bands) bytes_.push_back(std::exchange(band.bytes, nullptr));
    auto growing = std::make_shared<GrowingAtlas>(std::move(atlas));
    server_.broadcaster().begin(growing);
    return growing;
  }

  void put(GrowingAtlas& growing, size_t band) { growing.put(band, bytes_[band]); }

  void complete(GrowingAtlas& growing) {
    server_.broadcaster().publish(growing.complete({.coverage = {.hit = 1}}));
  }

  static Message::MessageCase next(TestWatcher& watcher) {
    const auto message = watcher.readMessage();
    return message ? message->message_case() : Message::MESSAGE_NOT_SET;
  }

  TestServer server_;
  TestPublisher publisher_{server_.connect(), "scene"};
  v1::OpenDisplay open_ = smallQuilt("scene");
  std::optional<TestWatcher> watcher_;
  std::vector<SharedBytes> bytes_;
};

TEST_F(GrowingAtlases, leaveBandByBand) {
  const GrowingAtlasPtr growing = begin();
  put(*growing, 0);
  EXPECT_EQ(next(*watcher_), Message::kHeader);
  const auto band = watcher_->readMessage();
  ASSERT_TRUE(band && band->has_band()) << "while the other is not packed";
  EXPECT_EQ(band->band().data().size(), bytes_[0]->size());
  put(*growing, 1);
  EXPECT_EQ(next(*watcher_), Message::kBand) << "while its outcome is not known";
  complete(*growing);
  const auto end = watcher_->readMessage();
  ASSERT_TRUE(end && end->has_end());
  EXPECT_EQ(end->end().coverage().hit(), 1);
}

TEST_F(GrowingAtlases, comeFromTheirStartToThoseWhoJoinMeanwhile) {
  const GrowingAtlasPtr growing = begin();
  put(*growing, 0);
  EXPECT_EQ(next(*watcher_), Message::kHeader);
  EXPECT_EQ(next(*watcher_), Message::kBand);
  TestWatcher joiner(server_.connect(), open_);
  EXPECT_EQ(joiner.readAtlas()->header.sequence(), 1u) << "the newest whole one, at once";
  const auto header = joiner.readMessage();
  ASSERT_TRUE(header && header->has_header());
  EXPECT_EQ(header->header().sequence(), 2u);
  const auto band = joiner.readMessage();
  ASSERT_TRUE(band && band->has_band());
  EXPECT_EQ(band->band().first_row(), 0u);
  put(*growing, 1);
  complete(*growing);
  for (TestWatcher* watcher : {&*watcher_, &joiner}) {
    EXPECT_EQ(next(*watcher), Message::kBand);
    EXPECT_EQ(next(*watcher), Message::kEnd);
  }
}

TEST_F(GrowingAtlases, areToldToBeAbandoned) {
  const GrowingAtlasPtr broken = begin();
  put(*broken, 0);
  EXPECT_EQ(next(*watcher_), Message::kHeader);
  broken->abandon();
  const GrowingAtlasPtr whole = begin();
  put(*whole, 0);
  put(*whole, 1);
  complete(*whole);
  EXPECT_EQ(next(*watcher_), Message::kBand);
  const auto told = watcher_->readMessage();
  ASSERT_TRUE(told && told->has_abandoned());
  EXPECT_EQ(told->abandoned().sequence(), 2u);
  const auto atlas = watcher_->readAtlas();
  ASSERT_TRUE(atlas.has_value());
  EXPECT_EQ(atlas->header.sequence(), 3u);
  EXPECT_EQ(atlas->skipped_count, 0u) << "the client was not too slow";
}

TEST_F(GrowingAtlases, areAbandonedForAClientThatChangesItsDisplay) {
  const GrowingAtlasPtr growing = begin();
  put(*growing, 0);
  EXPECT_EQ(next(*watcher_), Message::kHeader);
  EXPECT_EQ(next(*watcher_), Message::kBand);
  TestWatcher other(server_.connect(), open_);
  EXPECT_EQ(other.readAtlas()->header.sequence(), 1u);
  v1::StreamAtlasesRequest change;
  *change.mutable_change()->mutable_display() = open_.display();
  change.mutable_change()->mutable_display()->mutable_quilt()->mutable_size()->set_width(32);
  ASSERT_TRUE(watcher_->send(change));
  EXPECT_EQ(next(*watcher_), Message::kAbandoned) << "nobody waits for it to become whole";
  EXPECT_EQ(watcher_->readAtlas()->layout->size().width(), 32u);
  put(*growing, 1);
  complete(*growing);
  EXPECT_EQ(other.readAtlas()->header.sequence(), 2u) << "others get it all the same";
}

TEST_F(GrowingAtlases, waitForNobodyWhoDoesNotRead) {
  TestWatcher never(server_.connect(), open_);
  for (uint64_t sequence = 2; sequence < 300; ++sequence) {
    const GrowingAtlasPtr growing = begin();
    put(*growing, 0);
    put(*growing, 1);
    complete(*growing);
    EXPECT_EQ(watcher_->readAtlas()->header.sequence(), sequence);
  }
}

}  // namespace
}  // namespace viewloom::rpc_growing_test
