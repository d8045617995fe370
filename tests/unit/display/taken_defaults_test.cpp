// SPDX-License-Identifier: Apache-2.0
#include "display/taken_defaults.h"

#include <gtest/gtest.h>

namespace viewloom::taken_defaults_test {
namespace {

SourceStats range(double near_m, double far_m) {
  SourceStats stats;
  stats.inv_z_near = stats.inv_z_max = 1 / near_m;
  stats.inv_z_far = stats.inv_z_min = 1 / far_m;
  return stats;
}

class TakenDefaultsTest : public ::testing::Test {
 protected:
  // True where the defaults are those of this frame.
  bool follow(const SourceStats& stats, uint64_t session = 1) {
    now_ns_ += 33'000'000;
    return defaults_.follow(session, stats, now_ns_);
  }
  uint64_t count() const { return defaults_.taking().count; }
  DefaultsReason reason() const { return defaults_.taking().reason; }

  TakenDefaults defaults_;
  int64_t now_ns_ = 0;
};

TEST_F(TakenDefaultsTest, areThoseOfTheFirstFrame) {
  EXPECT_TRUE(follow(range(1, 3)));
  EXPECT_FALSE(follow(range(1.5, 5)));
  EXPECT_FALSE(follow(range(0.5, 2)));
  EXPECT_EQ(defaults_.stats().inv_z_near, 1);
  EXPECT_EQ(reason(), DefaultsReason::kFirstFrame);
}

TEST_F(TakenDefaultsTest, startAnewWithAnotherSession) {
  follow(range(1500, 4000));
  EXPECT_TRUE(follow(range(1.5, 4), 2));
  EXPECT_EQ(reason(), DefaultsReason::kNewPublisher);
  EXPECT_DOUBLE_EQ(defaults_.stats().inv_z_near, 1 / 1.5);
  EXPECT_TRUE(follow(range(1.4, 4), 3)) << "however little it differs";
  EXPECT_EQ(count(), 3U);
}

TEST_F(TakenDefaultsTest, stayWhereAnotherSessionShowsTheSame) {
  follow(range(1, 3));
  EXPECT_FALSE(defaults_.isBegunBy(2, range(1, 3)));
  EXPECT_FALSE(follow(range(1, 3), 2));
  EXPECT_FALSE(follow(range(1.1, 3), 2)) << "this is no first frame";
  EXPECT_EQ(count(), 1U);
}

TEST_F(TakenDefaultsTest, startAnewWhereDepthMovesByMoreThanAFactorOfFour) {
  follow(range(1, 3));
  EXPECT_FALSE(follow(range(3.9, 11.7)));
  EXPECT_TRUE(follow(range(4.1, 12.3)));
  EXPECT_EQ(reason(), DefaultsReason::kDepthMoved);
  now_ns_ += 2 * kMoveRest_ns;
  EXPECT_FALSE(follow(range(1.1, 3.3)));
  EXPECT_TRUE(follow(range(1, 3)));
}

TEST_F(TakenDefaultsTest, followAnEndOfTheRangeThatMovesAlone) {
  follow(range(9, 10));
  EXPECT_TRUE(follow(range(9, 100))) << "the span of 1/Z grows to nine times of it";
  now_ns_ += 2 * kMoveRest_ns;
  EXPECT_TRUE(follow(range(2, 100)));
}

TEST_F(TakenDefaultsTest, doNotFollowSkyThatComesAndGoesBehindAScene) {
  follow(range(1, 5));
  for (int i = 0; i < 5; ++i) {
    EXPECT_FALSE(follow(range(1, 1e12)));
    EXPECT_FALSE(follow(range(1, 5)));
  }
}

TEST_F(TakenDefaultsTest, stayWhileDepthTremblesAroundTheFactor) {
  follow(range(1, 3));
  for (int i = 0; i < 1000; ++i) follow(i % 2 == 0 ? range(4.1, 12.3) : range(3.9, 11.7));
  EXPECT_EQ(count(), 2U);
}

TEST_F(TakenDefaultsTest, doNotFlipWithEveryFrameOfASceneThatJumpsToAndFro) {
  follow(range(1, 3));
  for (int i = 0; i < 300; ++i) follow(i % 2 == 0 ? range(5, 15) : range(1, 3));  // 10 s
  EXPECT_LE(count(), 12U) << "more than once a second";
  EXPECT_GE(count(), 2U);
}

TEST_F(TakenDefaultsTest, ignoreFramesWithoutASurface) {
  follow(range(1, 3));
  EXPECT_FALSE(follow(SourceStats{}));
  EXPECT_FALSE(follow(range(1, 3)));
  EXPECT_EQ(count(), 1U);
}

TEST_F(TakenDefaultsTest, areTakenFromTheFirstFrameThatHasASurface) {
  EXPECT_TRUE(follow(SourceStats{}));
  EXPECT_TRUE(follow(range(1500, 4000)));
  EXPECT_FALSE(follow(range(1500, 4000)));
}

TEST(DepthRangeText, saysBothEndsInMetres) {
  EXPECT_EQ(depthRangeText(range(1.5, 4)), "1.5 to 4 m");
  EXPECT_EQ(depthRangeText(range(1788, 4000)), "1788 to 4000 m");
  SourceStats sky = range(2, 4);
  sky.inv_z_far = 0;
  EXPECT_EQ(depthRangeText(sky), "2 m to infinity");
  EXPECT_EQ(depthRangeText({}), "no surface");
}

}  // namespace
}  // namespace viewloom::taken_defaults_test
