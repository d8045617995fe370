// SPDX-License-Identifier: Apache-2.0
// Publishers and clients that come, go, fight and vanish, all at once: for the sanitizers above
// all.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <thread>
#include <vector>

#include "e2e/bystander.h"

namespace viewloom::rpc_churn_test {
namespace {

constexpr unsigned kThreadCount = 4;
constexpr int kRoundCount = 25;

// One of 0..count - 1.
unsigned pick(std::mt19937& random, unsigned count) {
  return std::uniform_int_distribution<unsigned>(0, count - 1)(random);
}

// Calls visit(random) over and over on several threads, each with a seed of its own.
template <typename Visit>
std::vector<std::jthread> churn(const Visit& visit) {
  std::vector<std::jthread> threads;
  for (unsigned seed = 1; seed <= kThreadCount; ++seed) {
    threads.emplace_back([seed, &visit] {
      std::mt19937 random(seed);
      for (int round = 0; round < kRoundCount; ++round) visit(random);
    });
  }
  return threads;
}

TEST(Churn, leavesOthersUndisturbed) {
  TestServer server;
  Bystander bystander(server);
  // Each takes the stream from whoever has it, sends some frames and leaves in one of three ways.
  const auto publish = [&server](std::mt19937& random) {
    TestPublisher publisher(server.connect(), "contested", "secret");
    const uint64_t frame_count = pick(random, 4);
    for (uint64_t number = 1; number <= frame_count; ++number) publisher.sendFrame(number);
    const unsigned way = pick(random, 3);
    if (way == 0) publisher.cancel();
    if (way == 1) publisher.halfClose();
    if (way == 2) publisher.sendChunk(chunkOf(9, 9, "nonsense"));
    EXPECT_FALSE(way != 1 && publisher.finish().ok());
  };
  // Each watches one of two displays, may change to the other, and leaves at any moment.
  const auto watch = [&server](std::mt19937& random) {
    v1::OpenDisplay open = smallQuilt("contested");
    open.set_wait_for_stream(true);
    open.mutable_display()->mutable_quilt()->set_view_count(1 + pick(random, 2));
    open.set_count(pick(random, 2));
    TestWatcher watcher(server.connect(), open);
    if (pick(random, 2) == 0) {
      v1::StreamAtlasesRequest request;
      *request.mutable_change()->mutable_display() = smallQuilt("contested").display();
      watcher.send(request);
    }
    if (pick(random, 2) == 0) watcher.cancel();
  };
  {
    const auto publishers = churn(publish);
    const auto watchers = churn(watch);
    for (int i = 0; i < kRoundCount; ++i) bystander.expectUndisturbed();
  }
  bystander.expectUndisturbed();
}

TEST(Churn, holdsTwoAtlasesAtMostForAClientThatNeverReads) {
  TestServer server;
  TestPublisher publisher(server.connect(), "scene");
  publisher.sendFrame(1);
  publisher.readReport();
  v1::OpenDisplay large = smallQuilt("scene");
  large.mutable_display()->mutable_quilt()->mutable_size()->set_width(8192);
  large.mutable_display()->mutable_quilt()->mutable_size()->set_height(256);
  TestWatcher never(server.connect(), large);
  while (publisher.readWanted()->display_count() == 0) {  // until it watches
  }
  const uint64_t display_id = server.broadcaster().displays("scene").front()->id;
  std::vector<std::weak_ptr<const EncodedAtlas>> published;
  for (uint64_t number = 2; number <= 20; ++number) {
    publisher.sendFrame(number);
    publisher.readReport();
    published.push_back(server.broadcaster().newest(display_id));
  }
  const auto alive = std::count_if(published.begin(), published.end(),
                                   [](const auto& atlas) { return !atlas.expired(); });
  EXPECT_LE(alive, 2) << "the one being written, and the newest";
}

}  // namespace
}  // namespace viewloom::rpc_churn_test
