// SPDX-License-Identifier: Apache-2.0
// Readers of a broadcaster's display that move to its second rung and back.
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/publish/paced_readers.h"

namespace viewloom::test::second_rung_test {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr double kSlow = 300;

class SecondRungTest : public testing::Test {
 protected:
  SecondRungTest() {
    broadcaster_.onDemandChange([this](const std::string& stream) { demands_.push_back(stream); });
  }

  SubscriptionPtr watch(const EncodingSpec& encoding = kAdapting) {
    return join(broadcaster_, "s", quiltOf(2), std::make_shared<Watcher>(), encoding);
  }

  std::shared_ptr<DisplayCoding> codingOf(const SubscriptionPtr& place) const {
    return broadcaster_.display(place->displayId())->coding;
  }

  // The first move that a reader wants within so long, while ten atlases come in a second.
  std::optional<RungMove> wantedWithin(int64_t duration_ms, PacedReader& wanting,
                                       const std::vector<PacedReader*>& readers) {
    for (const int64_t end_ns = now_ns_ + duration_ms * kMs; now_ns_ < end_ns;) {
      auto bytes = codeAtlases(broadcaster_, "s", now_ns_, coding_ns_);
      for (PacedReader* const reader : readers) {
        reader->offer(bytes[reader->place->displayId()], now_ns_);
      }
      now_ns_ += kAtlasesApart_ns;
      used_ns_ += int64_t(busy_core_count_ * kAtlasesApart_ns);
      broadcaster_.remakeStanding(now_ns_);
      if (const auto move = wanting.place->wantedMove(now_ns_)) return move;
    }
    return std::nullopt;
  }

  // The move that the slow reader wants of video that is encoded so.
  std::optional<RungMove> wantedOf(const EncodingSpec& encoding) {
    fast_ = {.place = watch(encoding)};
    slow_ = {.place = watch(encoding), .bytes_per_ms = kSlow};
    return wantedWithin(5000, slow_, {&fast_, &slow_});
  }

  absl::Status move(PacedReader& reader, const RungMove& move) {
    auto place = broadcaster_.moveToRung(move, std::make_shared<Watcher>(), now_ns_);
    if (place.ok()) reader.place = *std::move(place);
    return place.status();
  }

  int64_t now_ns_ = 1000 * kMs;
  int64_t used_ns_ = 0;
  double busy_core_count_ = 0.5;
  int64_t coding_ns_ = 30 * kMs;
  CodingRoom room_{2, [this] { return used_ns_; }};
  std::vector<std::string> demands_;
  Broadcaster broadcaster_{
      {.display_count_max = 2, .subscriber_count_max = 4}, unboundedMemory(), room_};
  PacedReader fast_{.place = watch()};
  PacedReader slow_{.place = watch(), .bytes_per_ms = kSlow};
};

TEST_F(SecondRungTest, isMadeWhileAReaderIsFarBelowTheOthers) {
  EXPECT_FALSE(wantedWithin(2500, slow_, {&fast_, &slow_}));
  const auto wanted = wantedWithin(2000, slow_, {&fast_, &slow_});
  ASSERT_TRUE(wanted.has_value());
  EXPECT_EQ(wanted->to, VideoRung::kSecond);
  ASSERT_TRUE(move(slow_, *wanted).ok());
  EXPECT_NE(slow_.place->displayId(), fast_.place->displayId());
  const ActiveDisplayPtr first = broadcaster_.display(fast_.place->displayId());
  const ActiveDisplayPtr second = broadcaster_.display(slow_.place->displayId());
  EXPECT_EQ(second->picture_key, first->picture_key) << "they share one trace";
  EXPECT_EQ(second->encoding, onOtherRung(first->encoding));
  EXPECT_EQ(first->subscriber_count, 1u);
  EXPECT_EQ(second->subscriber_count, 1u);
  EXPECT_EQ(first->coding->beginAtlas(now_ns_), 24u);
  EXPECT_GE(second->coding->beginAtlas(now_ns_), 32u) << "from its first atlas on";
  EXPECT_FALSE(wantedWithin(5000, fast_, {&fast_, &slow_}));
  slow_.place = nullptr;
  EXPECT_EQ(broadcaster_.displays("s").size(), 1u);
}

TEST_F(SecondRungTest, isSharedByAllThatAreSlow) {
  PacedReader other{.place = watch(), .bytes_per_ms = kSlow};
  PacedReader third{.place = watch()};
  const std::vector<PacedReader*> all = {&fast_, &slow_, &other, &third};
  const auto wanted = wantedWithin(5000, slow_, all);
  ASSERT_TRUE(wanted.has_value());
  ASSERT_TRUE(move(slow_, *wanted).ok()) << "it needs no fifth place";
  const auto later = wantedWithin(5000, other, all);
  ASSERT_TRUE(later.has_value());
  ASSERT_TRUE(move(other, *later).ok()) << "one encoding serves both: it costs nothing more";
  EXPECT_EQ(other.place->displayId(), slow_.place->displayId());
  EXPECT_EQ(broadcaster_.displays("s").size(), 2u);
  EXPECT_FALSE(wantedWithin(5000, other, all)) << "there is no third rung";
}

TEST_F(SecondRungTest, isLeftOnceTheLineAllowsTheFirst) {
  const auto wanted = wantedWithin(5000, slow_, {&fast_, &slow_});
  ASSERT_TRUE(wanted.has_value());
  ASSERT_TRUE(move(slow_, *wanted).ok());
  EXPECT_FALSE(wantedWithin(10'000, slow_, {&fast_, &slow_}));
  slow_.bytes_per_ms = 0;
  const auto back = wantedWithin(20'000, slow_, {&fast_, &slow_});
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->to, VideoRung::kFirst);
  ASSERT_TRUE(move(slow_, *back).ok());
  EXPECT_EQ(slow_.place->displayId(), fast_.place->displayId());
  EXPECT_EQ(broadcaster_.displays("s").size(), 1u);
}

TEST_F(SecondRungTest, isLeftWhereNobodyIsOnTheFirst) {
  const auto wanted = wantedWithin(5000, slow_, {&fast_, &slow_});
  ASSERT_TRUE(wanted.has_value());
  ASSERT_TRUE(move(slow_, *wanted).ok());
  fast_.place = nullptr;
  const auto back = wantedWithin(5000, slow_, {&slow_});
  ASSERT_TRUE(back.has_value());
  ASSERT_TRUE(move(slow_, *back).ok());
  EXPECT_EQ(broadcaster_.display(slow_.place->displayId())->encoding.rung, VideoRung::kFirst);
  EXPECT_GE(codingOf(slow_.place)->beginAtlas(now_ns_), 32u) << "its line is as it was";
}

TEST_F(SecondRungTest, isNotMadeWithoutTimeToCodeIt) {
  busy_core_count_ = 1.5;
  const auto wanted = wantedWithin(5000, slow_, {&fast_, &slow_});
  ASSERT_TRUE(wanted.has_value());
  EXPECT_EQ(move(slow_, *wanted).code(), absl::StatusCode::kResourceExhausted) << "1.8 of 2 cores";
  EXPECT_EQ(slow_.place->displayId(), fast_.place->displayId());
  EXPECT_FALSE(wantedWithin(2500, slow_, {&fast_, &slow_})) << "it is asked for after a while";
  coding_ns_ = 5 * kMs;
  const auto again = wantedWithin(1500, slow_, {&fast_, &slow_});
  ASSERT_TRUE(again.has_value());
  EXPECT_TRUE(move(slow_, *again).ok());
}

TEST_F(SecondRungTest, takesNoTimeWhereThereIsNoPlaceForIt) {
  const auto other = join(broadcaster_, "other", quiltOf(2), std::make_shared<Watcher>());
  const auto wanted = wantedWithin(5000, slow_, {&fast_, &slow_});
  ASSERT_TRUE(wanted.has_value());
  EXPECT_EQ(move(slow_, *wanted).code(), absl::StatusCode::kResourceExhausted);
  EXPECT_TRUE(room_.take(0.1, now_ns_)) << "another display has it";
}

TEST_F(SecondRungTest, goesOnceOthersNeedItsTime) {
  const auto wanted = wantedWithin(5000, slow_, {&fast_, &slow_});
  ASSERT_TRUE(wanted.has_value());
  ASSERT_TRUE(move(slow_, *wanted).ok());
  busy_core_count_ = 2;
  const auto back = wantedWithin(8000, slow_, {&fast_, &slow_});
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->to, VideoRung::kFirst);
  EXPECT_TRUE(move(slow_, *back).ok());
  const auto again = wantedWithin(5000, slow_, {&fast_, &slow_});
  ASSERT_TRUE(again.has_value());
  EXPECT_FALSE(move(slow_, *again).ok());
}

TEST_F(SecondRungTest, isCodedAtOnceForItsFirstReader) {
  const auto wanted = wantedWithin(5000, slow_, {&fast_, &slow_});
  ASSERT_TRUE(wanted.has_value());
  demands_.clear();
  ASSERT_TRUE(move(slow_, *wanted).ok());
  EXPECT_THAT(demands_, testing::ElementsAre("s")) << "no frame may come for a long time";
}

TEST_F(SecondRungTest, givesAReaderTheNewestAtlas) {
  const auto wanted = wantedWithin(5000, slow_, {&fast_, &slow_});
  ASSERT_TRUE(wanted.has_value());
  ASSERT_TRUE(move(slow_, *wanted).ok());
  broadcaster_.publish(atlasOf(fast_.place->displayId(), 7));
  const auto watcher = std::make_shared<Watcher>();
  const RungMove back = {slow_.place->place(), VideoRung::kFirst};
  const auto place = broadcaster_.moveToRung(back, watcher, now_ns_);
  ASSERT_TRUE(place.ok()) << place.status();
  EXPECT_THAT(watcher->sequences(), testing::ElementsAre(7));
}

TEST_F(SecondRungTest, getsAnAtlasThatNeedsNoOtherAlsoForAReaderThatMayNotTakeItYet) {
  EncodingSpec chained = kAdapting;
  chained.prediction = Prediction::kAcrossAtlases;
  chained.bits_per_second_max = 80'000'000;
  const auto wanted = wantedOf(chained);
  ASSERT_TRUE(wanted.has_value());
  ASSERT_TRUE(move(slow_, *wanted).ok());
  const uint64_t first_id = fast_.place->displayId();
  const auto chain = broadcaster_.display(first_id)->chain;
  for (const uint64_t sequence : {uint64_t{1}, uint64_t{2}}) {
    auto atlas = std::make_shared<EncodedAtlas>(*atlasOf(first_id, sequence));
    atlas->reference_sequence = chain->begin(sequence, now_ns_);
    chain->noteWhole(sequence);
    broadcaster_.publish(atlas);
  }
  slow_.place->beginWrite(20'000'000, now_ns_);
  slow_.place->endAtlas(now_ns_);
  ASSERT_FALSE(slow_.place->mayBegin(now_ns_));
  const RungMove back = {slow_.place->place(), VideoRung::kFirst};
  ASSERT_TRUE(move(slow_, back).ok());
  EXPECT_TRUE(chain->wantsAgain(now_ns_ + 300 * kMs)) << "frames may stand";
}

TEST_F(SecondRungTest, hasAChainOfItsOwn) {
  EncodingSpec chained = kAdapting;
  chained.prediction = Prediction::kAcrossAtlases;
  const auto wanted = wantedOf(chained);
  ASSERT_TRUE(wanted.has_value());
  ASSERT_TRUE(move(slow_, *wanted).ok());
  const auto first = broadcaster_.display(fast_.place->displayId())->chain;
  const auto second = broadcaster_.display(slow_.place->displayId())->chain;
  ASSERT_NE(second, nullptr);
  EXPECT_NE(second, first);
  EXPECT_EQ(second->begin(1, now_ns_), 0u) << "the first atlas there needs no other";
}

TEST_F(SecondRungTest, keepsAReaderToItsBits) {
  EncodingSpec limited = kAdapting;
  limited.bits_per_second_max = 80'000'000;
  const auto wanted = wantedOf(limited);
  ASSERT_TRUE(wanted.has_value());
  slow_.place->beginWrite(100'000'000, now_ns_);
  slow_.place->endAtlas(now_ns_);
  ASSERT_TRUE(move(slow_, *wanted).ok());
  EXPECT_FALSE(slow_.place->mayBegin(now_ns_ + 5000 * kMs)) << "it got the bits of ten seconds";
  EXPECT_TRUE(slow_.place->mayBegin(now_ns_ + 10'000 * kMs));
}

TEST_F(SecondRungTest, isNothingForVideoOfOneQuality) {
  const EncodingSpec fixed = {.color = BandEncoding::kH264, .video_qp = 24};
  EncodingSpec limited = fixed;
  limited.bits_per_second_max = 80'000'000;
  fast_.place = nullptr;
  slow_.place = nullptr;
  PacedReader alone{.place = watch(fixed), .bytes_per_ms = kSlow};
  PacedReader fast{.place = watch(limited)};
  PacedReader slow{.place = watch(limited), .bytes_per_ms = kSlow};
  for (; now_ns_ < 20'000 * kMs; now_ns_ += 100 * kMs) {
    EXPECT_FALSE(alone.place->wantedMove(now_ns_));
  }
  alone.place = nullptr;
  EXPECT_FALSE(wantedWithin(10'000, slow, {&fast, &slow}));
}

}  // namespace
}  // namespace viewloom::test::second_rung_test
