// SPDX-License-Identifier: Apache-2.0
#include "web/movie_threads.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/thread_time.h"

namespace viewloom::movie_threads_test {
namespace {

Claim claimOf(const std::string& identity) {
  return {.payers = {Payer(identity)}, .stream = "demo", .display = "quilt.mp4"};
}

void spend(int64_t time_ns) {
  const int64_t until_ns = threadTimeNs() + time_ns;
  while (threadTimeNs() < until_ns) {
  }
}

class MovieThreadsTest : public testing::Test {
 protected:
  void run(const std::string& identity, std::function<void()> work) {
    threads_->run({.claim = claimOf(identity), .px_count = 1000, .work = std::move(work)});
  }

  FairShares shares_;
  Metrics metrics_;
  std::unique_ptr<MovieThreads> threads_ = std::make_unique<MovieThreads>(1, shares_, metrics_);
};

TEST_F(MovieThreadsTest, chargesWhoeverWatches) {
  std::promise<void> is_done;
  run("10.0.0.1", [&] { spend(60'000'000); });
  run("10.0.0.1", [&] { is_done.set_value(); });
  is_done.get_future().wait();
  EXPECT_TRUE(shares_.goesBefore(claimOf("10.0.0.2"), claimOf("10.0.0.1")));
  threads_ = nullptr;
  EXPECT_GE(metrics_.engine_seconds[PayerClass::kRemote].value(), 0.06);
}

TEST_F(MovieThreadsTest, goInFairShares) {
  std::promise<void> is_free;
  std::promise<void> are_done;
  std::vector<std::string> order;
  run("10.0.0.1", [&] { spend(60'000'000); });
  run("10.0.0.1", [future = is_free.get_future().share()] { future.wait(); });
  run("10.0.0.1", [&] {
    order.push_back("the one with many");
    are_done.set_value();
  });
  run("10.0.0.2", [&] { order.push_back("the one with few"); });
  is_free.set_value();
  are_done.get_future().wait();
  EXPECT_THAT(order, testing::ElementsAre("the one with few", "the one with many"));
}

}  // namespace
}  // namespace viewloom::movie_threads_test
