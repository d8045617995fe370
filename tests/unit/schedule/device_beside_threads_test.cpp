// SPDX-License-Identifier: Apache-2.0
// Fair shares of those whose work threads do, while a device works for others. Time of the few that
// have the device passes faster than that of the many who share the threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/cost_estimate.h"
#include "schedule/fair_shares.h"

namespace viewloom::device_beside_threads_test {
namespace {

constexpr size_t kCount = 4;
constexpr int kTurns = 400;

Claim claimOf(const std::string& identity) {
  return {.payers = {Payer(identity)}, .stream = "s", .display = "quilt"};
}

// A device and one thread, which do a piece each in every turn: for one identity on the device, and
// for others on the thread.
class Server {
 public:
  // Serves the one of them that goes first. Returns its place.
  size_t serveNext(const std::vector<const Claim*>& on_thread) {
    serve(on_device_);
    return serveOnThread(on_thread);
  }
  // The same, if the device takes the thread's core. Returns whether the device served.
  bool serveOnOneCore(const std::vector<const Claim*>& on_thread) {
    const Claim& first = *on_thread[shares_.nextOf(on_thread).value()];
    if (shares_.hasHadLess(first, on_device_)) {
      serveOnThread(on_thread);
      return false;
    }
    serve(on_device_);
    return true;
  }

 private:
  size_t serveOnThread(const std::vector<const Claim*>& claims) {
    const size_t next = shares_.nextOf(claims).value();
    serve(*claims[next]);
    return next;
  }
  void serve(const Claim& claim) {
    shares_.begin(claim, kPiece_ns);
    shares_.finish(claim, kPiece_ns, kPiece_ns);
  }

  FairShares shares_;
  const Claim on_device_ = claimOf("device");
};

struct DeviceBesideThreads : testing::Test {
  DeviceBesideThreads() {
    for (size_t i = 0; i < kCount; ++i) claims.push_back(claimOf(std::to_string(i)));
    for (const Claim& claim : claims) waiting.push_back(&claim);
  }

  Server server;
  std::vector<Claim> claims;
  std::vector<const Claim*> waiting;  // on the thread
};

TEST_F(DeviceBesideThreads, threadsServeAllAlike) {
  std::vector<int> piece_counts(kCount);
  for (int turn = 0; turn < kTurns; ++turn) ++piece_counts[server.serveNext(waiting)];
  for (size_t i = 0; i < kCount; ++i) EXPECT_NEAR(piece_counts[i], kTurns / int(kCount), 4) << i;
}

TEST_F(DeviceBesideThreads, aSmallPictureWaitsForOneRoundOfTheOthersAtMost) {
  constexpr int kInterval = 10;
  const Claim small = claimOf("small");
  waiting.push_back(nullptr);
  int made_count = 0;
  int wait = 0;
  int longest_wait = 0;
  for (int turn = 0; turn < kTurns; ++turn) {
    if (turn % kInterval == 0) waiting.back() = &small;
    const bool is_small = server.serveNext(waiting) == kCount;
    wait = is_small || waiting.back() == nullptr ? 0 : wait + 1;
    longest_wait = std::max(longest_wait, wait);
    if (!is_small) continue;
    waiting.back() = nullptr;
    ++made_count;
  }
  EXPECT_EQ(made_count, kTurns / kInterval);
  EXPECT_LE(longest_wait, int(kCount));
}

TEST_F(DeviceBesideThreads, aDeviceThatTakesTheirCoresHasAShareLikeTheOthers) {
  int device_count = 0;
  for (int turn = 0; turn < kTurns; ++turn) device_count += server.serveOnOneCore(waiting) ? 1 : 0;
  EXPECT_NEAR(device_count, kTurns / int(kCount + 1), 4);
}

}  // namespace
}  // namespace viewloom::device_beside_threads_test
