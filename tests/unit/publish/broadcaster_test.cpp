// SPDX-License-Identifier: Apache-2.0
#include "publish/broadcaster.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/publish/watcher.h"

namespace viewloom::test::broadcaster_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Broadcaster, givesEqualDisplaysOneIdAndOnePictureToOtherEncodings) {
  Broadcaster broadcaster({});
  const auto watcher = std::make_shared<Watcher>();
  const auto first = join(broadcaster, "a", quiltOf(2), watcher);
  const auto same = join(broadcaster, "a", quiltOf(2), watcher);
  const auto other_stream = join(broadcaster, "b", quiltOf(2), watcher);
  const auto other_picture = join(broadcaster, "a", quiltOf(3), watcher);
  const auto other_encoding = join(broadcaster, "a", quiltOf(2), watcher, {.jpeg_quality = 50});
  EXPECT_EQ(first->displayId(), same->displayId());
  const auto displays = broadcaster.displays("");
  ASSERT_EQ(displays.size(), 4u);
  EXPECT_EQ(displays[0]->subscriber_count, 2u);
  EXPECT_EQ(displays[0]->picture_key, displays[3]->picture_key);
  EXPECT_NE(displays[0]->picture_key, displays[1]->picture_key);
  EXPECT_NE(displays[0]->picture_key, displays[2]->picture_key);
  EXPECT_EQ(broadcaster.displays("a").size(), 3u);
  EXPECT_EQ(broadcaster.subscriberCount("a"), 4u);
  EXPECT_EQ(broadcaster.subscriberCount("c"), 0u);
}

TEST(Broadcaster, handsEachAtlasToAllWatchersOfItsDisplayAlone) {
  Broadcaster broadcaster({});
  const auto one = std::make_shared<Watcher>();
  const auto two = std::make_shared<Watcher>();
  const auto stranger = std::make_shared<Watcher>();
  const auto a = join(broadcaster, "s", quiltOf(2), one);
  const auto b = join(broadcaster, "s", quiltOf(2), two);
  const auto c = join(broadcaster, "s", quiltOf(3), stranger);
  broadcaster.publish(atlasOf(a->displayId(), 1));
  broadcaster.publish(atlasOf(a->displayId(), 2));
  EXPECT_THAT(one->sequences(), ElementsAre(1, 2));
  EXPECT_THAT(two->sequences(), ElementsAre(1, 2));
  EXPECT_THAT(stranger->sequences(), IsEmpty());
  EXPECT_EQ(broadcaster.atlasCount(a->displayId()), 2u);
  EXPECT_EQ(broadcaster.newest(a->displayId())->sequence, 2u);
  EXPECT_EQ(broadcaster.newest(c->displayId()), nullptr);
}

TEST(Broadcaster, givesEveryWatcherOfATrackedDisplayOneOfHisOwn) {
  Broadcaster broadcaster({});
  const DisplaySpec tracked =
      *completeDisplaySpec({.kind = StereoSpec{.eye_size_px = {100, 100}, .is_tracked = true}});
  const auto eyes = std::make_shared<EyeTrack>();
  const auto watcher = std::make_shared<Watcher>();
  auto first = *broadcaster.subscribe("s", tracked, {}, watcher, eyes);
  const auto second =
      *broadcaster.subscribe("s", tracked, {}, watcher, std::make_shared<EyeTrack>());
  const auto displays = broadcaster.displays("s");
  ASSERT_EQ(displays.size(), 2u);
  EXPECT_NE(displays[0]->picture_key, displays[1]->picture_key);
  EXPECT_EQ(displays[0]->eyes, eyes);
  const uint64_t first_id = first->displayId();
  EXPECT_EQ(broadcaster.display(first_id), displays[0]);
  EXPECT_EQ(broadcaster.display(second->displayId()), displays[1]);
  first.reset();
  EXPECT_EQ(broadcaster.display(first_id), nullptr) << "nobody watches it any more";
}

TEST(Broadcaster, tellsALayoutBeforeAnAtlasIsTraced) {
  Broadcaster broadcaster({});
  auto a = join(broadcaster, "s", quiltOf(2), std::make_shared<Watcher>());
  const uint64_t id = a->displayId();
  EXPECT_EQ(broadcaster.layout(id), nullptr);
  const auto layout = std::make_shared<const AtlasLayout>();
  broadcaster.noteLayout(id, layout);
  EXPECT_EQ(broadcaster.layout(id), layout);
  EXPECT_EQ(broadcaster.newest(id), nullptr);
  a.reset();
  broadcaster.noteLayout(id, layout);
  EXPECT_EQ(broadcaster.layout(id), nullptr) << "nobody watches it any more";
}

TEST(Broadcaster, givesALateJoinerTheNewestCompleteAtlasAtOnce) {
  Broadcaster broadcaster({});
  std::vector<std::string> demands;
  broadcaster.onDemandChange([&](const std::string& stream) { demands.push_back(stream); });
  const auto first = join(broadcaster, "s", quiltOf(2), std::make_shared<Watcher>());
  broadcaster.publish(atlasOf(first->displayId(), 1));
  broadcaster.publish(atlasOf(first->displayId(), 2));
  const auto late = std::make_shared<Watcher>();
  const auto second = join(broadcaster, "s", quiltOf(2), late);
  EXPECT_THAT(late->sequences(), ElementsAre(2));
  EXPECT_THAT(demands, ElementsAre("s")) << "the late joiner is served and asks for nothing";
}

TEST(Broadcaster, tellsAllWatchersOfAnAtlasThatIsBeingMade) {
  Broadcaster broadcaster({});
  const auto one = std::make_shared<Watcher>();
  const auto two = std::make_shared<Watcher>();
  const auto a = join(broadcaster, "s", quiltOf(2), one);
  const auto b = join(broadcaster, "s", quiltOf(2), two);
  const uint64_t id = a->displayId();
  EXPECT_EQ(broadcaster.nextSequence(id), 1u);
  const auto growing = std::make_shared<GrowingAtlas>(begunAtlas(id, 1, 0));
  broadcaster.begin(growing);
  EXPECT_THAT(one->begun(), ElementsAre(growing));
  EXPECT_THAT(two->begun(), ElementsAre(growing)) << "the same bytes for all";
  EXPECT_THAT(one->sequences(), IsEmpty()) << "it is not whole";
  EXPECT_EQ(broadcaster.newest(id), nullptr);
  EXPECT_EQ(broadcaster.nextSequence(id), 2u);
  broadcaster.publish(growing->complete({}));
  EXPECT_THAT(one->sequences(), ElementsAre(1));
  EXPECT_EQ(broadcaster.nextSequence(id), 2u);
}

TEST(Broadcaster, givesAJoinerTheNewestWholeAtlasAndTheOneThatIsBeingMade) {
  Broadcaster broadcaster({});
  const auto first = join(broadcaster, "s", quiltOf(2), std::make_shared<Watcher>());
  const uint64_t id = first->displayId();
  broadcaster.publish(atlasOf(id, 1));
  const auto growing = std::make_shared<GrowingAtlas>(begunAtlas(id, 2, 0));
  broadcaster.begin(growing);
  const auto late = std::make_shared<Watcher>();
  const auto second = join(broadcaster, "s", quiltOf(2), late);
  EXPECT_THAT(late->sequences(), ElementsAre(1));
  EXPECT_THAT(late->begun(), ElementsAre(growing));
  broadcaster.publish(growing->complete({}));
  const auto later = std::make_shared<Watcher>();
  const auto third = join(broadcaster, "s", quiltOf(2), later);
  EXPECT_THAT(later->sequences(), ElementsAre(2));
  EXPECT_THAT(later->begun(), IsEmpty()) << "it is whole";
}

TEST(Broadcaster, tellsNobodyOfAnAtlasOfADisplayThatIsLeft) {
  Broadcaster broadcaster({});
  const auto watcher = std::make_shared<Watcher>();
  auto place = join(broadcaster, "s", quiltOf(2), watcher);
  const uint64_t id = place->displayId();
  place.reset();
  broadcaster.begin(std::make_shared<GrowingAtlas>(begunAtlas(id, 1)));
  EXPECT_THAT(watcher->begun(), IsEmpty());
  EXPECT_EQ(broadcaster.nextSequence(id), 1u);
}

TEST(Broadcaster, asksForAnAtlasWhenAJoinerFindsNone) {
  Broadcaster broadcaster({});
  int demand_count = 0;
  broadcaster.onDemandChange([&](const std::string&) { ++demand_count; });
  const auto first = join(broadcaster, "s", quiltOf(2), std::make_shared<Watcher>());
  const auto second = join(broadcaster, "s", quiltOf(2), std::make_shared<Watcher>());
  EXPECT_EQ(demand_count, 2);
}

TEST(Broadcaster, forgetsADisplayThatNobodyWatches) {
  Broadcaster broadcaster({});
  std::vector<std::string> demands;
  broadcaster.onDemandChange([&](const std::string& stream) { demands.push_back(stream); });
  auto first = join(broadcaster, "s", quiltOf(2), std::make_shared<Watcher>());
  auto second = join(broadcaster, "s", quiltOf(2), std::make_shared<Watcher>());
  const uint64_t id = first->displayId();
  broadcaster.publish(atlasOf(id, 1));
  std::weak_ptr<const EncodedAtlas> atlas = broadcaster.newest(id);
  first.reset();
  EXPECT_EQ(broadcaster.displays("s").at(0)->subscriber_count, 1u);
  demands.clear();
  second.reset();
  EXPECT_THAT(broadcaster.displays("s"), IsEmpty());
  EXPECT_EQ(broadcaster.newest(id), nullptr);
  EXPECT_TRUE(atlas.expired());
  EXPECT_THAT(demands, ElementsAre("s"));
  broadcaster.publish(atlasOf(id, 2));  // finished too late: dropped
  EXPECT_EQ(broadcaster.atlasCount(id), 0u);
}

TEST(Broadcaster, refusesOverItsLimitsAndServesAgainWhenThereIsRoom) {
  Broadcaster broadcaster({.display_count_max = 1, .subscriber_count_max = 2});
  const auto watcher = std::make_shared<Watcher>();
  auto first = join(broadcaster, "s", quiltOf(2), watcher);
  EXPECT_EQ(broadcaster.subscribe("s", quiltOf(3), {}, watcher).status().code(),
            absl::StatusCode::kResourceExhausted);
  auto second = join(broadcaster, "s", quiltOf(2), watcher);
  EXPECT_EQ(broadcaster.subscribe("s", quiltOf(2), {}, watcher).status().code(),
            absl::StatusCode::kResourceExhausted);
  first.reset();
  second.reset();
  const auto third = join(broadcaster, "s", quiltOf(3), watcher);
  EXPECT_EQ(broadcaster.displays("s").size(), 1u);
}

TEST(Broadcaster, endsTheWatchersOfADisplayThatCannotBeServed) {
  Broadcaster broadcaster({});
  const auto refused = std::make_shared<Watcher>();
  const auto served = std::make_shared<Watcher>();
  const auto a = join(broadcaster, "s", quiltOf(2), refused);
  const auto b = join(broadcaster, "s", quiltOf(3), served);
  broadcaster.refuse(a->displayId(), absl::FailedPreconditionError("no"));
  ASSERT_EQ(refused->ends().size(), 1u);
  EXPECT_EQ(refused->ends()[0].code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(served->ends(), IsEmpty());
  broadcaster.publish(atlasOf(a->displayId(), 1));
  EXPECT_THAT(refused->sequences(), IsEmpty());
  EXPECT_EQ(broadcaster.displays("s").size(), 1u);
}

TEST(Broadcaster, endsEverybodyWithOkWhenItDrainsAndTakesNobodyNew) {
  Broadcaster broadcaster({});
  const auto one = std::make_shared<Watcher>();
  const auto two = std::make_shared<Watcher>();
  const auto a = join(broadcaster, "s", quiltOf(2), one);
  const auto b = join(broadcaster, "t", quiltOf(3), two);
  broadcaster.drain();
  broadcaster.drain();
  EXPECT_THAT(one->ends(), ElementsAre(absl::OkStatus()));
  EXPECT_THAT(two->ends(), ElementsAre(absl::OkStatus()));
  EXPECT_THAT(broadcaster.displays(""), IsEmpty());
  EXPECT_EQ(broadcaster.subscribe("s", quiltOf(2), {}, one).status().code(),
            absl::StatusCode::kUnavailable);
}

// Leaves with its first atlas, from within the call that brings it.
class OneShotWatcher final : public Watcher {
 public:
  void offer(AtlasPtr atlas) override {
    Watcher::offer(std::move(atlas));
    subscription.reset();
  }
  SubscriptionPtr subscription;
};

TEST(Broadcaster, letsAWatcherLeaveFromWithinAnOffer) {
  Broadcaster broadcaster({});
  const auto watcher = std::make_shared<OneShotWatcher>();
  watcher->subscription = join(broadcaster, "s", quiltOf(2), watcher);
  const uint64_t id = watcher->subscription->displayId();
  broadcaster.publish(atlasOf(id, 1));
  broadcaster.publish(atlasOf(id, 2));
  EXPECT_THAT(watcher->sequences(), ElementsAre(1));
  EXPECT_THAT(broadcaster.displays("s"), IsEmpty());
}

TEST(Broadcaster, opensNoDisplayForWhichThereIsNoMemory) {
  MemoryBudget memory(64'000'000);
  Broadcaster broadcaster({}, memory);
  const auto watcher = std::make_shared<Watcher>();
  DisplaySpec large;
  large.kind = QuiltSpec{.columns = 2, .rows = 2, .size_px = {8192, 8192}};
  const auto refused = broadcaster.subscribe("s", *completeDisplaySpec(large), {}, watcher);
  EXPECT_EQ(refused.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(fieldOf(refused.status()), "quilt.size");
  EXPECT_TRUE(broadcaster.displays("s").empty());
  EXPECT_EQ(memory.reservedBytes(), 0u);
}

TEST(Broadcaster, givesTheMemoryOfADisplayBackWithItsLastViewer) {
  MemoryBudget memory(1'000'000'000);
  Broadcaster broadcaster({}, memory);
  const auto watcher = std::make_shared<Watcher>();
  auto first = join(broadcaster, "s", quiltOf(2), watcher);
  const uint64_t display_bytes = memory.reservedBytes(MemoryUse::kDisplays);
  const uint64_t viewer_bytes = memory.reservedBytes(MemoryUse::kViewers);
  EXPECT_GT(display_bytes, 0u);
  auto second = join(broadcaster, "s", quiltOf(2), watcher);
  EXPECT_EQ(memory.reservedBytes(MemoryUse::kDisplays), display_bytes);
  EXPECT_EQ(memory.reservedBytes(MemoryUse::kViewers), 2 * viewer_bytes);
  first.reset();
  EXPECT_EQ(memory.reservedBytes(), display_bytes + viewer_bytes);
  second.reset();
  EXPECT_EQ(memory.reservedBytes(), 0u);
}

}  // namespace
}  // namespace viewloom::test::broadcaster_test
