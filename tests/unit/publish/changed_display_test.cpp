// SPDX-License-Identifier: Apache-2.0
// A viewer that changes its display.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "publish/broadcaster.h"
#include "unit/publish/watcher.h"

namespace viewloom::test::changed_display_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(ChangedDisplay, needsNoSecondPlaceForAChange) {
  Broadcaster broadcaster({.display_count_max = 1, .subscriber_count_max = 1});
  std::vector<std::string> demands;
  broadcaster.onDemandChange([&](const std::string& stream) { demands.push_back(stream); });
  const auto before = std::make_shared<Watcher>();
  auto old = join(broadcaster, "s", quiltOf(2), before);
  demands.clear();
  const auto after = std::make_shared<Watcher>();
  auto changed = broadcaster.subscribe("s", quiltOf(3), {}, after, nullptr, old->place());
  ASSERT_TRUE(changed.ok()) << changed.status();
  EXPECT_EQ(broadcaster.displays("s").size(), 1u);
  EXPECT_THAT(demands, Contains("s"));
  old.reset();
  EXPECT_EQ(broadcaster.subscriberCount("s"), 1u);
  broadcaster.publish(atlasOf((*changed)->displayId(), 1));
  EXPECT_THAT(after->sequences(), ElementsAre(1));
  EXPECT_THAT(before->sequences(), IsEmpty());
  // The same display again keeps its newest atlas.
  const auto again = std::make_shared<Watcher>();
  auto same = broadcaster.subscribe("s", quiltOf(3), {}, again, nullptr, (*changed)->place());
  ASSERT_TRUE(same.ok()) << same.status();
  EXPECT_THAT(again->sequences(), ElementsAre(1));
}

TEST(ChangedDisplay, keepsTheOldPlaceOfAChangeThatItRefuses) {
  Broadcaster broadcaster({.display_count_max = 1});
  const auto watcher = std::make_shared<Watcher>();
  const auto old = join(broadcaster, "s", quiltOf(2), watcher);
  const auto other = join(broadcaster, "s", quiltOf(2), std::make_shared<Watcher>());
  const auto refused = broadcaster.subscribe("s", quiltOf(3), {}, std::make_shared<Watcher>(),
                                             nullptr, old->place());
  EXPECT_EQ(refused.status().code(), absl::StatusCode::kResourceExhausted);
  broadcaster.publish(atlasOf(old->displayId(), 1));
  EXPECT_THAT(watcher->sequences(), ElementsAre(1));
}

}  // namespace
}  // namespace viewloom::test::changed_display_test
