// SPDX-License-Identifier: Apache-2.0
// The broadcaster while publishers, joiners and leavers run against each other.
#include <atomic>
#include <functional>
#include <future>
#include <thread>

#include <gtest/gtest.h>

#include "publish/broadcaster.h"
#include "unit/publish/watcher.h"

namespace viewloom::test::broadcaster_threads_test {
namespace {

// Stands in an offer until it is let go.
class StuckWatcher final : public Subscriber {
 public:
  void offer(AtlasPtr) override {
    entered.set_value();
    release.get_future().wait();
  }
  void end(const absl::Status&) override {}
  std::promise<void> entered;
  std::promise<void> release;
};

TEST(Broadcaster, keepsServingOthersWhileOneWatcherIsStuck) {
  Broadcaster broadcaster({});
  const auto stuck = std::make_shared<StuckWatcher>();
  const auto well = std::make_shared<Watcher>();
  const auto a = join(broadcaster, "s", quiltOf(2), stuck);
  const auto b = join(broadcaster, "s", quiltOf(3), well);
  std::jthread blocked([&] { broadcaster.publish(atlasOf(a->displayId(), 1)); });
  stuck->entered.get_future().wait();
  for (uint64_t sequence = 1; sequence <= 100; ++sequence) {
    broadcaster.publish(atlasOf(b->displayId(), sequence));
  }
  auto joiner = join(broadcaster, "s", quiltOf(3), std::make_shared<Watcher>());
  joiner.reset();
  EXPECT_EQ(well->sequences().size(), 100u);
  stuck->release.set_value();
}

TEST(Broadcaster, keepsOrderForEveryWatcherUnderThreads) {
  constexpr uint64_t kAtlasCount = 2000;
  constexpr int kJoinerThreads = 3;
  Broadcaster broadcaster({});
  std::atomic<int> demand_count = 0;
  broadcaster.onDemandChange([&](const std::string&) { ++demand_count; });
  const auto steady = std::make_shared<Watcher>();
  const auto hold = join(broadcaster, "s", quiltOf(2), steady);
  std::atomic<bool> published = false;
  std::vector<std::shared_ptr<Watcher>> joined[kJoinerThreads];
  {
    std::vector<std::jthread> threads;
    for (auto& watchers : joined) {
      threads.emplace_back([&] {
        while (!published) {
          watchers.push_back(std::make_shared<Watcher>());
          const auto brief = join(broadcaster, "s", quiltOf(2), watchers.back());
          EXPECT_GE(broadcaster.displays("s").at(0)->subscriber_count, 2u);
          std::this_thread::yield();
        }
      });
    }
    for (uint64_t sequence = 1; sequence <= kAtlasCount; ++sequence) {
      broadcaster.publish(atlasOf(hold->displayId(), sequence));
    }
    published = true;
  }
  EXPECT_EQ(steady->sequences().size(), kAtlasCount);
  EXPECT_FALSE(steady->misused());
  for (const auto& watchers : joined) {
    for (const auto& watcher : watchers) {
      const std::vector<uint64_t> sequences = watcher->sequences();
      EXPECT_TRUE(std::ranges::is_sorted(sequences, std::less_equal<>()));
      EXPECT_FALSE(watcher->misused());
    }
  }
  EXPECT_EQ(broadcaster.subscriberCount("s"), 1u);
}

TEST(Broadcaster, offersNothingAfterTheEndUnderThreads) {
  for (int round = 0; round < 50; ++round) {
    Broadcaster broadcaster({});
    const auto watcher = std::make_shared<Watcher>();
    const auto subscription = join(broadcaster, "s", quiltOf(2), watcher);
    {
      std::jthread publisher([&] {
        for (uint64_t sequence = 1; sequence <= 50; ++sequence) {
          broadcaster.publish(atlasOf(subscription->displayId(), sequence));
        }
      });
      std::jthread drainer([&] { broadcaster.drain(); });
      std::jthread refuser(
          [&] { broadcaster.refuse(subscription->displayId(), absl::InternalError("refused")); });
    }
    EXPECT_EQ(watcher->ends().size(), 1u);
    EXPECT_FALSE(watcher->misused());
  }
}

}  // namespace
}  // namespace viewloom::test::broadcaster_threads_test
