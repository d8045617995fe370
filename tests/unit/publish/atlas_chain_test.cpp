// SPDX-License-Identifier: Apache-2.0
#include "publish/atlas_chain.h"

#include <gtest/gtest.h>

namespace viewloom::test::atlas_chain_test {
namespace {

constexpr int64_t kMs = 1'000'000;

class AtlasChainTest : public testing::Test {
 protected:
  // The next atlas, coded whole. Sequence that it refers to.
  uint64_t make(int64_t now_ns) {
    const uint64_t reference = chain_.begin(++sequence_, now_ns);
    chain_.noteWhole(sequence_);
    return reference;
  }

  AtlasChain chain_;
  uint64_t sequence_ = 0;
};

TEST_F(AtlasChainTest, refersToTheAtlasBefore) {
  EXPECT_EQ(make(0), 0u);
  EXPECT_EQ(make(33 * kMs), 1u);
  EXPECT_EQ(make(66 * kMs), 2u);
}

TEST_F(AtlasChainTest, turnsTheOrderOfThePicturesRound) {
  EXPECT_EQ(chain_.nextOrder(), PictureOrder::kForward);
  chain_.begin(1, 0, PictureOrder::kForward);
  EXPECT_EQ(chain_.nextOrder(), PictureOrder::kBackward);
  chain_.begin(2, 33 * kMs, PictureOrder::kBackward);
  EXPECT_EQ(chain_.nextOrder(), PictureOrder::kForward);
  // Another display of the same picture had decided.
  chain_.begin(3, 66 * kMs, PictureOrder::kBackward);
  EXPECT_EQ(chain_.nextOrder(), PictureOrder::kForward);
}

TEST_F(AtlasChainTest, needsNoOtherAfterOneThatWasNotCompleted) {
  make(0);
  EXPECT_EQ(chain_.begin(++sequence_, 33 * kMs), 1u);
  EXPECT_EQ(make(66 * kMs), 0u);
  EXPECT_EQ(make(99 * kMs), 3u);
}

TEST_F(AtlasChainTest, givesAllReadersTogetherOneAtATime) {
  make(0);
  make(33 * kMs);
  chain_.want();
  chain_.want();
  EXPECT_EQ(make(66 * kMs), 2u) << "the last one began 66 ms before";
  EXPECT_EQ(make(200 * kMs), 0u);
  EXPECT_EQ(make(233 * kMs), 4u);
  chain_.want();
  EXPECT_EQ(make(399 * kMs), 5u);
  EXPECT_EQ(make(400 * kMs), 0u);
}

TEST_F(AtlasChainTest, asksForNoneWhereOneComes) {
  make(0);
  make(300 * kMs);
  chain_.want();
  EXPECT_EQ(chain_.begin(++sequence_, 600 * kMs), 0u);
  chain_.want();  // a reader that has not got it yet
  chain_.noteWhole(sequence_);
  EXPECT_EQ(make(900 * kMs), 3u);
}

TEST_F(AtlasChainTest, wantsTheNewestAgainWhereFramesStand) {
  make(0);
  make(300 * kMs);
  EXPECT_FALSE(chain_.wantsAgain(5000 * kMs)) << "nobody waits";
  chain_.want();
  EXPECT_FALSE(chain_.wantsAgain(400 * kMs));
  EXPECT_FALSE(chain_.isDue());
  EXPECT_TRUE(chain_.wantsAgain(550 * kMs));
  EXPECT_TRUE(chain_.isDue());
  EXPECT_EQ(make(560 * kMs), 0u);
  EXPECT_FALSE(chain_.isDue());
  EXPECT_FALSE(chain_.wantsAgain(5000 * kMs));
}

TEST_F(AtlasChainTest, isDueAtOnceForOneThatJoins) {
  make(0);
  chain_.wantAtOnce();
  EXPECT_FALSE(chain_.isDue()) << "the newest needs no other";
  make(33 * kMs);
  EXPECT_FALSE(chain_.wantsAgain(280 * kMs)) << "nobody waits";
  chain_.wantAtOnce();
  EXPECT_TRUE(chain_.isDue());
  EXPECT_EQ(make(300 * kMs), 0u);
}

TEST_F(AtlasChainTest, makesNothingAtOnceThatWouldReferToOthers) {
  make(0);
  make(33 * kMs);
  chain_.wantAtOnce();
  EXPECT_FALSE(chain_.isDue()) << "the last one that needs no other began 33 ms before";
  EXPECT_EQ(make(66 * kMs), 2u);
  EXPECT_TRUE(chain_.wantsAgain(316 * kMs)) << "frames stand";
  EXPECT_EQ(make(320 * kMs), 0u);
}

}  // namespace
}  // namespace viewloom::test::atlas_chain_test
