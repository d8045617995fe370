// SPDX-License-Identifier: Apache-2.0
// Which atlases a call writes, without one.
#include "rpc/atlas_outbox.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "messages/wire_message.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom::atlas_outbox_test {
namespace {

SharedBytes someBytes() {
  return std::make_shared<std::vector<uint8_t>>(size_t{3});
}

class AtlasOutboxTest : public testing::Test {
 protected:
  // A begun atlas of two bands.
  EncodedAtlas begun(uint64_t sequence) const {
    EncodedAtlas atlas;
    atlas.sequence = sequence;
    atlas.layout = layout_;
    for (uint32_t band = 0; band < 2; ++band) {
      atlas.bands.push_back({.first_row = 128 * band,
                             .row_count = 128,
                             .encoding = BandEncoding::kRaw,
                             .bytes = nullptr});
    }
    return atlas;
  }

  AtlasPtr whole(uint64_t sequence) const {
    EncodedAtlas atlas = begun(sequence);
    for (EncodedBand& band : atlas.bands) band.bytes = someBytes();
    return std::make_shared<EncodedAtlas>(std::move(atlas));
  }

  AtlasPtr chained(uint64_t sequence, uint64_t reference) const {
    EncodedAtlas atlas = *whole(sequence);
    atlas.reference_sequence = reference;
    return std::make_shared<EncodedAtlas>(std::move(atlas));
  }

  GrowingAtlasPtr grow(uint64_t sequence) {
    auto growing = std::make_shared<GrowingAtlas>(begun(sequence));
    outbox_.begin(growing, 1);
    return growing;
  }

  void complete(GrowingAtlas& growing) {
    for (size_t band = 0; band < 2; ++band) {
      if (growing.atlas().bands[band].bytes == nullptr) growing.put(band, someBytes());
    }
    outbox_.offer(growing.complete({}));
  }

  // Messages that leave now: "L" layout, "S2" skipped, "h1" header of atlas 1, "b" band, "e" end,
  // "a" abandoned.
  std::string written(size_t count_max = 100) {
    std::string text;
    for (size_t i = 0; i < count_max; ++i) {
      std::optional<grpc::ByteBuffer> bytes = outbox_.take(true);
      if (!bytes) break;
      v1::StreamAtlasesResponse message;
      EXPECT_TRUE(parseMessage(*bytes, message).ok());
      if (message.has_layout()) text += "L";
      if (message.has_skipped()) text += "S" + std::to_string(message.skipped().count());
      if (message.has_header()) text += "h" + std::to_string(message.header().sequence());
      if (message.has_band()) text += "b";
      if (message.has_end()) text += "e";
      if (message.has_abandoned()) text += "a";
    }
    return text;
  }

  Metrics metrics_;
  AtlasOutbox outbox_{metrics_};
  const std::shared_ptr<const AtlasLayout> layout_ = std::make_shared<AtlasLayout>();
};

TEST_F(AtlasOutboxTest, writesBandsOfAnAtlasThatIsBeingMade) {
  const GrowingAtlasPtr growing = grow(1);
  EXPECT_EQ(written(), "") << "nothing is begun that might wait for long";
  growing->put(0, someBytes());
  EXPECT_EQ(written(), "Lh1b");
  complete(*growing);
  EXPECT_EQ(written(), "be");
  EXPECT_EQ(written(), "") << "what was offered is what was written";
}

TEST_F(AtlasOutboxTest, saysWhichMessageEndsAnAtlas) {
  outbox_.offer(whole(1));
  EXPECT_EQ(written(3), "Lh1b");
  EXPECT_FALSE(outbox_.hasEndedAtlas());
  EXPECT_EQ(written(2), "be");
  EXPECT_TRUE(outbox_.hasEndedAtlas());
  EXPECT_EQ(written(), "");
  EXPECT_FALSE(outbox_.hasEndedAtlas());
  const GrowingAtlasPtr growing = grow(2);
  growing->put(0, someBytes());
  EXPECT_EQ(written(), "h2b");
  growing->abandon();
  EXPECT_EQ(written(1), "a");
  EXPECT_TRUE(outbox_.hasEndedAtlas());
}

TEST_F(AtlasOutboxTest, finishesTheOlderAtlasOfAClientThatIsSlow) {
  const GrowingAtlasPtr first = grow(1);
  complete(*first);
  EXPECT_EQ(written(2), "Lh1");
  for (uint64_t sequence = 2; sequence <= 4; ++sequence) complete(*grow(sequence));
  const GrowingAtlasPtr newest = grow(5);
  newest->put(0, someBytes());
  EXPECT_EQ(written(), "bbeS2h4bbeh5b");
  complete(*newest);
  EXPECT_EQ(written(), "be");
  EXPECT_EQ(metrics_.replaced[HandOver::kGrpc].value(), 2);
}

TEST_F(AtlasOutboxTest, writesAllChainedAtlasesInOrder) {
  outbox_.offer(chained(1, 0));
  EXPECT_EQ(written(2), "Lh1");
  for (uint64_t sequence = 2; sequence <= 4; ++sequence) {
    outbox_.offer(chained(sequence, sequence - 1));
  }
  EXPECT_EQ(written(), "bbeh2bbeh3bbeh4bbe");
  EXPECT_FALSE(outbox_.isStuck());
}

TEST_F(AtlasOutboxTest, writesNothingThatRefersToAnAtlasThatTheClientHasNotGot) {
  outbox_.offer(chained(3, 2));
  EXPECT_EQ(written(), "");
  EXPECT_TRUE(outbox_.isStuck());
  outbox_.offer(chained(4, 0));
  EXPECT_FALSE(outbox_.isStuck());
  EXPECT_EQ(written(), "Lh4bbe") << "one that joins skips nothing";
  outbox_.offer(chained(6, 5));
  outbox_.offer(chained(7, 0));
  EXPECT_EQ(written(), "S1h7bbe");
  EXPECT_EQ(outbox_.fallOutCount(), 1u);
  EXPECT_EQ(metrics_.replaced[HandOver::kGrpc].value(), 1);
}

TEST_F(AtlasOutboxTest, beginsAChainedAtlasThatIsBeingMadeOnlyBehindItsReference) {
  const auto growAfter = [&](uint64_t sequence, uint64_t reference) {
    EncodedAtlas atlas = begun(sequence);
    atlas.reference_sequence = reference;
    auto growing = std::make_shared<GrowingAtlas>(std::move(atlas));
    outbox_.begin(growing, 1);
    growing->put(0, someBytes());
    return growing;
  };
  const GrowingAtlasPtr first = growAfter(2, 1);
  EXPECT_EQ(written(), "");
  complete(*first);
  EXPECT_TRUE(outbox_.isStuck());
  const GrowingAtlasPtr second = growAfter(3, 0);
  EXPECT_EQ(written(), "Lh3b");
  EXPECT_FALSE(outbox_.isStuck());
  complete(*second);
  const GrowingAtlasPtr third = growAfter(4, 3);
  EXPECT_EQ(written(), "beh4b");
  third->abandon();
  EXPECT_EQ(written(), "a");
  outbox_.offer(chained(5, 4));
  EXPECT_EQ(written(), "") << "the client has not got 4";
}

TEST_F(AtlasOutboxTest, keepsTheChainOfAnotherDisplayWhereAnAtlasOfTheFirstIsLost) {
  grow(1)->put(0, someBytes());
  EXPECT_EQ(written(), "Lh1b");
  outbox_.restart(nullptr);
  outbox_.offer(chained(1, 0));
  EXPECT_EQ(written(), "aLh1bbe");
  outbox_.offer(chained(2, 1));
  EXPECT_EQ(written(), "h2bbe");
}

TEST_F(AtlasOutboxTest, writesTheNewestWholeAtlasBeforeOneThatIsBeingMade) {
  outbox_.offer(whole(7));
  const GrowingAtlasPtr growing = grow(8);
  growing->put(0, someBytes());
  EXPECT_EQ(written(), "Lh7bbeh8b");
}

TEST_F(AtlasOutboxTest, holdsTwoAtlasesAtMostForAClientThatIsSlow) {
  outbox_.offer(whole(1));
  EXPECT_EQ(written(2), "Lh1");
  std::vector<std::weak_ptr<const GrowingAtlas>> begun_atlases;
  std::vector<std::weak_ptr<const EncodedAtlas>> offered;
  for (uint64_t sequence = 2; sequence < 9; ++sequence) {
    const GrowingAtlasPtr growing = grow(sequence);
    begun_atlases.push_back(growing);
    complete(*growing);
    AtlasPtr atlas = whole(sequence);
    offered.push_back(atlas);
    outbox_.offer(std::move(atlas));
  }
  for (const auto& growing : begun_atlases) EXPECT_TRUE(growing.expired());
  size_t held_count = 0;
  for (const auto& atlas : offered) held_count += !atlas.expired();
  EXPECT_EQ(held_count, 1u) << "beside the one that is being written";
}

TEST_F(AtlasOutboxTest, saysThatAnAtlasIsAbandonedAndGoesOn) {
  const GrowingAtlasPtr broken = grow(1);
  broken->put(0, someBytes());
  EXPECT_EQ(written(), "Lh1b");
  broken->abandon();
  EXPECT_EQ(written(), "a");
  outbox_.offer(whole(2));
  EXPECT_EQ(written(), "h2bbe");
}

TEST_F(AtlasOutboxTest, isSilentOfAnAbandonedAtlasThatItHasNotBegun) {
  const GrowingAtlasPtr broken = grow(1);
  broken->put(0, someBytes());
  broken->abandon();
  EXPECT_EQ(written(), "");
  outbox_.offer(whole(2));
  EXPECT_EQ(written(), "Lh2bbe");
}

TEST_F(AtlasOutboxTest, abandonsWhatAChangedDisplayHasBegun) {
  const GrowingAtlasPtr old = grow(5);
  old->put(0, someBytes());
  EXPECT_EQ(written(), "Lh5b");
  outbox_.restart(nullptr);
  EXPECT_EQ(written(), "a");
  outbox_.offer(whole(1));
  EXPECT_EQ(written(), "Lh1bbe") << "the sequence starts anew";
}

TEST_F(AtlasOutboxTest, finishesAWholeAtlasBeforeAChange) {
  outbox_.offer(whole(5));
  EXPECT_EQ(written(3), "Lh5b");
  outbox_.restart(nullptr);
  EXPECT_EQ(written(), "be");
}

TEST_F(AtlasOutboxTest, countsWholeAtlasesAlone) {
  outbox_.limit(1);
  const GrowingAtlasPtr broken = grow(1);
  broken->put(0, someBytes());
  EXPECT_EQ(written(), "Lh1b");
  broken->abandon();
  EXPECT_EQ(written(), "a");
  EXPECT_FALSE(outbox_.isThrough());
  outbox_.offer(whole(2));
  outbox_.offer(whole(3));
  EXPECT_EQ(written(), "S1h3bbe");
  EXPECT_TRUE(outbox_.isThrough());
  outbox_.offer(whole(4));
  EXPECT_EQ(written(), "");
}

TEST_F(AtlasOutboxTest, writesWhatIsWholeWhenTheServerDrains) {
  outbox_.offer(whole(1));
  outbox_.close(true);
  EXPECT_EQ(written(), "Lh1bbe");
  outbox_.offer(whole(2));
  outbox_.close(false);
  EXPECT_EQ(written(), "");
}

}  // namespace
}  // namespace viewloom::atlas_outbox_test
