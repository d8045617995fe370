// SPDX-License-Identifier: Apache-2.0
// Displays of a broadcaster whose quality adapts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/publish/watcher.h"

namespace viewloom::test::adapting_display_test {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr EncodingSpec kAdapting = {
    .color = BandEncoding::kH264, .video_qp = 24, .video_qp_max = 40};

// The reader's socket is busy for a second with each atlas.
void readSlowly(Broadcaster::Subscription& reader, int64_t from_ns) {
  reader.beginWrite(100'000, from_ns);
  reader.endAtlas(from_ns + 1000 * kMs);
}

TEST(AdaptingDisplay, hasOneQualityForAllItsReaders) {
  Broadcaster broadcaster({});
  const auto one = join(broadcaster, "s", quiltOf(2), std::make_shared<Watcher>(), kAdapting);
  const auto two = join(broadcaster, "s", quiltOf(2), std::make_shared<Watcher>(), kAdapting);
  const auto fixed = join(broadcaster, "s", quiltOf(2), std::make_shared<Watcher>(),
                          {.color = BandEncoding::kH264, .video_qp = 24});
  EXPECT_EQ(one->displayId(), two->displayId());
  EXPECT_NE(one->displayId(), fixed->displayId());
  EXPECT_EQ(broadcaster.display(fixed->displayId())->coding, nullptr);
  EXPECT_TRUE(fixed->mayBegin(0));
  const auto coding = broadcaster.display(one->displayId())->coding;
  ASSERT_NE(coding, nullptr);
  EXPECT_EQ(broadcaster.display(one->displayId())->picture_key,
            broadcaster.display(fixed->displayId())->picture_key);
}

TEST(AdaptingDisplay, countsReadersOnlyWhileTheyAreThere) {
  Broadcaster broadcaster({});
  auto slow = join(broadcaster, "s", quiltOf(2), std::make_shared<Watcher>(), kAdapting);
  const auto coding = broadcaster.display(slow->displayId())->coding;
  coding->noteCoded(coding->beginAtlas(0), 500'000);
  readSlowly(*slow, 0);
  EXPECT_EQ(coding->beginAtlas(1000 * kMs), 40u);
  const auto fast = join(broadcaster, "s", quiltOf(2), std::make_shared<Watcher>(), kAdapting);
  slow.reset();
  EXPECT_EQ(coding->beginAtlas(2500 * kMs), 36u) << "no line shows a limit any more";
}

TEST(AdaptingDisplay, asksForItsAtlasAgainOnceFramesStand) {
  Broadcaster broadcaster({});
  std::vector<std::string> demands;
  broadcaster.onDemandChange([&](const std::string& stream) { demands.push_back(stream); });
  const auto slow = join(broadcaster, "s", quiltOf(2), std::make_shared<Watcher>(), kAdapting);
  const auto other = join(broadcaster, "t", quiltOf(2), std::make_shared<Watcher>(), kAdapting);
  demands.clear();
  const auto coding = broadcaster.display(slow->displayId())->coding;
  coding->noteCoded(coding->beginAtlas(0), 500'000);
  readSlowly(*slow, 0);
  EXPECT_EQ(coding->beginAtlas(1000 * kMs), 40u);
  broadcaster.remakeStanding(1200 * kMs);
  EXPECT_THAT(demands, testing::IsEmpty());
  broadcaster.remakeStanding(3500 * kMs);
  EXPECT_THAT(demands, testing::ElementsAre("s"));
  broadcaster.remakeStanding(4000 * kMs);
  EXPECT_THAT(demands, testing::ElementsAre("s")) << "it has not begun yet";
  EXPECT_EQ(coding->beginAtlas(4100 * kMs), 24u);
  broadcaster.remakeStanding(20'000 * kMs);
  EXPECT_THAT(demands, testing::ElementsAre("s")) << "it is the finest";
}

}  // namespace
}  // namespace viewloom::test::adapting_display_test
