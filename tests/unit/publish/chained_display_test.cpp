// SPDX-License-Identifier: Apache-2.0
// Displays of a broadcaster whose video is chained.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/publish/watcher.h"

namespace viewloom::test::chained_display_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr int64_t kMs = 1'000'000;
constexpr EncodingSpec kChained = {.color = BandEncoding::kH264,
                                   .prediction = Prediction::kAcrossAtlases};

class ChainedDisplayTest : public testing::Test {
 protected:
  ChainedDisplayTest() {
    broadcaster_.onDemandChange([this](const std::string& stream) { demands_.push_back(stream); });
  }

  SubscriptionPtr watch(const std::shared_ptr<Watcher>& watcher) {
    return join(broadcaster_, "s", quiltOf(2), watcher, kChained);
  }

  // The next atlas of the display, as the pipeline makes it. Sequence that it refers to.
  uint64_t make(uint64_t display_id, int64_t now_ns) {
    const uint64_t sequence = broadcaster_.nextSequence(display_id);
    const auto chain = broadcaster_.display(display_id)->chain;
    auto atlas = std::make_shared<EncodedAtlas>(*atlasOf(display_id, sequence));
    atlas->reference_sequence = chain->begin(sequence, now_ns);
    chain->noteWhole(sequence);
    broadcaster_.publish(atlas);
    return atlas->reference_sequence;
  }

  Broadcaster broadcaster_{{}};
  std::vector<std::string> demands_;
};

TEST_F(ChainedDisplayTest, isArrangedApartFromOthers) {
  const auto chained = watch(std::make_shared<Watcher>());
  const auto alone = join(broadcaster_, "s", quiltOf(2), std::make_shared<Watcher>(),
                          {.color = BandEncoding::kH264});
  EXPECT_EQ(broadcaster_.display(alone->displayId())->chain, nullptr);
  EXPECT_NE(broadcaster_.display(chained->displayId())->chain, nullptr);
  EXPECT_NE(broadcaster_.display(chained->displayId())->picture_key,
            broadcaster_.display(alone->displayId())->picture_key);
}

TEST_F(ChainedDisplayTest, givesAJoinerTheNewestOnlyWhereThatNeedsNoOther) {
  const auto first = watch(std::make_shared<Watcher>());
  make(first->displayId(), 0);
  const auto early = std::make_shared<Watcher>();
  const auto second = watch(early);
  EXPECT_THAT(early->sequences(), ElementsAre(1));
  make(first->displayId(), 300 * kMs);
  demands_.clear();
  const auto late = std::make_shared<Watcher>();
  const auto third = watch(late);
  EXPECT_THAT(late->sequences(), IsEmpty());
  EXPECT_THAT(demands_, ElementsAre("s")) << "the standing frame is coded anew";
  EXPECT_TRUE(broadcaster_.display(first->displayId())->isWantedAgain());
  EXPECT_EQ(make(first->displayId(), 400 * kMs), 0u);
  EXPECT_THAT(late->sequences(), ElementsAre(3));
  EXPECT_FALSE(broadcaster_.display(first->displayId())->isWantedAgain());
}

TEST_F(ChainedDisplayTest, makesAStandingAtlasAgainForAReaderThatHasFallenOut) {
  const auto reader = watch(std::make_shared<Watcher>());
  make(reader->displayId(), 0);
  make(reader->displayId(), 300 * kMs);
  demands_.clear();
  broadcaster_.remakeStanding(900 * kMs);
  EXPECT_THAT(demands_, IsEmpty());
  reader->wantSelfContained(900 * kMs);
  broadcaster_.remakeStanding(1000 * kMs);
  EXPECT_THAT(demands_, ElementsAre("s"));
}

TEST_F(ChainedDisplayTest, makesNoneForAReaderThatMayNotTakeIt) {
  EncodingSpec limited = kChained;
  limited.bits_per_second_max = 1'000'000;
  const auto reader = join(broadcaster_, "s", quiltOf(2), std::make_shared<Watcher>(), limited);
  make(reader->displayId(), 0);
  make(reader->displayId(), 300 * kMs);
  reader->beginWrite(250'000, 300 * kMs);
  reader->endAtlas(310 * kMs);
  demands_.clear();
  reader->wantSelfContained(900 * kMs);
  broadcaster_.remakeStanding(1000 * kMs);
  EXPECT_THAT(demands_, IsEmpty());
  reader->wantSelfContained(1500 * kMs);
  broadcaster_.remakeStanding(1500 * kMs);
  EXPECT_THAT(demands_, ElementsAre("s"));
}

}  // namespace
}  // namespace viewloom::test::chained_display_test
