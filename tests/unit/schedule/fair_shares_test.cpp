// SPDX-License-Identifier: Apache-2.0
// Simulation of identities that want more of a server than there is, by a clock that is turned by
// hand.
#include "schedule/fair_shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "base/cost_estimate.h"
#include "base/heap.h"

namespace viewloom::fair_shares_test {
namespace {

constexpr int64_t kMs_ns = 1'000'000;
constexpr int64_t kSecond_ns = 1000 * kMs_ns;

// One display with pictures to make.
struct Client {
  Claim claim;
  int64_t interval_ns = 0;  // from picture to picture; 0 = the next waits when one is made
  int64_t picture_ns = 0;   // work of a picture
  int64_t piece_ns = kPiece_ns;

  int64_t next_ns = 0;     // when the next picture is asked for
  int64_t asked_ns = 0;    // when the one in the making was
  int64_t left_ns = 0;     // of its work
  int64_t had_ns = 0;      // work that was done for it
  int64_t made_count = 0;  // pictures
  int64_t longest_wait_ns = 0;

  bool waits() const { return left_ns > 0; }
};

Client client(const std::string& identity, const std::string& display, int64_t picture_ns,
              int64_t interval_ns = 0) {
  Client client;
  client.claim = {.payers = {Payer(identity)}, .stream = "s", .display = display};
  client.interval_ns = interval_ns;
  client.picture_ns = picture_ns;
  return client;
}

// A server with one engine, which does a piece at a time.
class Server {
 public:
  void run(std::vector<Client>& clients, int64_t duration_ns) {
    const int64_t end_ns = now_ns_ + duration_ns;
    while (now_ns_ < end_ns) {
      for (Client& client : clients) ask(client);
      Client* const next = nextOf(clients);
      if (next == nullptr) {
        now_ns_ += kMs_ns;
        continue;
      }
      makePieceOf(*next);
    }
  }
  // Cuts work as the estimate says, of which a unit takes so long.
  void learn(CostEstimate& estimate, int64_t unit_ns) {
    estimate_ = &estimate;
    unit_ns_ = unit_ns;
  }
  // A prediction takes so many times as long as the work.
  void predict(double times) { predicted_times_ = times; }

 private:
  void ask(Client& client) {
    if (client.waits() || now_ns_ < client.next_ns) return;
    client.asked_ns = now_ns_;
    client.claim.deadline_ns = now_ns_;
    shares_.enter(client.claim);
    client.left_ns = client.picture_ns;
    client.next_ns = std::max(client.next_ns + client.interval_ns, now_ns_);
  }

  Client* nextOf(std::vector<Client>& clients) const {
    std::vector<const Claim*> claims;
    for (const Client& client : clients) claims.push_back(client.waits() ? &client.claim : nullptr);
    const std::optional<size_t> next = shares_.nextOf(claims);
    return next ? &clients[*next] : nullptr;
  }

  void makePieceOf(Client& client) {
    int64_t work_ns = std::min(client.piece_ns, client.left_ns);
    auto predicted_ns = int64_t(predicted_times_ * double(work_ns));
    if (estimate_ != nullptr) {
      const auto units =
          std::min<uint64_t>(estimate_->unitsFor(kPiece_ns), uint64_t(client.left_ns / unit_ns_));
      work_ns = int64_t(units) * unit_ns_;
      predicted_ns = estimate_->predictNs(units);
      estimate_->note(units, work_ns);
    }
    shares_.begin(client.claim, predicted_ns);
    now_ns_ += work_ns;
    shares_.finish(client.claim, predicted_ns, work_ns);
    client.left_ns -= work_ns;
    client.had_ns += work_ns;
    if (client.waits()) return;
    ++client.made_count;
    client.longest_wait_ns = std::max(client.longest_wait_ns, now_ns_ - client.asked_ns);
  }

  FairShares shares_;
  double predicted_times_ = 1;
  CostEstimate* estimate_ = nullptr;
  int64_t unit_ns_ = 1;
  int64_t now_ns_ = kSecond_ns;
};

std::string address(int number) {
  return "10.0.0." + std::to_string(number);
}

// `count` identities, each with a picture that takes hours.
std::vector<Client> greedy(int count) {
  std::vector<Client> clients;
  for (int i = 0; i < count; ++i) {
    clients.push_back(client(address(i + 2), "huge", 3600 * kSecond_ns));
  }
  return clients;
}

TEST(FairShares, aHealthyViewerGetsAllItsPicturesBesideGreedyIdentities) {
  for (const int count : {1, 8}) {
    SCOPED_TRACE(count);
    Server server;
    std::vector<Client> clients = greedy(count);
    server.run(clients, 30 * kSecond_ns);  // alone, before somebody else comes
    clients.push_back(client(address(1), "quilt", 8 * kMs_ns, 100 * kMs_ns));
    server.run(clients, 60 * kSecond_ns);
    const Client& healthy = clients.back();
    EXPECT_GE(healthy.made_count, 594) << "of 600";
    EXPECT_LE(healthy.longest_wait_ns, 19 * kMs_ns) << "a piece of somebody else, and its own";
  }
}

TEST(FairShares, whoAsksForMoreThanThereIsGetsAnEqualShare) {
  for (const int count : {1, 8}) {
    SCOPED_TRACE(count);
    Server server;
    std::vector<Client> clients = greedy(count);
    // Small pictures in small pieces, as fast as they come.
    clients.push_back(client(address(1), "quilt", 40 * kMs_ns));
    clients.back().piece_ns = 3 * kMs_ns;
    server.run(clients, 90 * kSecond_ns);
    const double share = double(clients.back().had_ns) / double(90 * kSecond_ns);
    EXPECT_NEAR(share, 1.0 / (count + 1), 0.2 / (count + 1));
  }
}

TEST(FairShares, oneIdentityGetsNoMoreWithManyStreamsAndDisplays) {
  Server server;
  std::vector<Client> clients;
  for (int i = 0; i < 60; ++i) {
    clients.push_back(client(address(2), std::to_string(i), 8 * kMs_ns));
    clients.back().claim.stream = "s" + std::to_string(i % 4);
  }
  clients.push_back(client(address(1), "quilt", 40 * kMs_ns));
  server.run(clients, 60 * kSecond_ns);
  EXPECT_NEAR(double(clients.back().had_ns), 30 * double(kSecond_ns), 3 * double(kSecond_ns));
}

TEST(FairShares, streamsOfOneIdentityAndDisplaysOfOneStreamShareAlike) {
  Server server;
  std::vector<Client> clients;
  for (int i = 0; i < 3; ++i) clients.push_back(client(address(1), std::to_string(i), kSecond_ns));
  clients.push_back(client(address(1), "other", 10 * kMs_ns));
  clients.back().claim.stream = "other stream";
  server.run(clients, 60 * kSecond_ns);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(double(clients[i].had_ns), 10 * double(kSecond_ns), double(kSecond_ns)) << i;
  }
  EXPECT_NEAR(double(clients.back().had_ns), 30 * double(kSecond_ns), double(kSecond_ns));
}

TEST(FairShares, wrongPredictionsDoNotChangeAShare) {
  for (const double times : {0.05, 20.0}) {
    SCOPED_TRACE(times);
    Server server;
    server.predict(times);
    std::vector<Client> clients = greedy(8);
    clients.push_back(client(address(1), "quilt", 40 * kMs_ns));
    server.run(clients, 90 * kSecond_ns);
    EXPECT_NEAR(double(clients.back().had_ns), 10 * double(kSecond_ns), 2 * double(kSecond_ns));
  }
}

// Units of work take five times as long as a safe start says.
TEST(FairShares, piecesOfUnknownCostAreSoonAsShortAsTheyShouldBe) {
  Server server;
  CostEstimate estimate(1000);
  server.learn(estimate, 5000);
  std::vector<Client> clients = greedy(8);
  clients.push_back(client(address(1), "quilt", 6 * kMs_ns, 100 * kMs_ns));
  server.run(clients, kSecond_ns);
  EXPECT_LE(clients.back().longest_wait_ns, 150 * kMs_ns);
  EXPECT_GE(clients.back().made_count, 9);
  clients.back().longest_wait_ns = 0;
  server.run(clients, 10 * kSecond_ns);
  EXPECT_LE(clients.back().longest_wait_ns, 20 * kMs_ns);
  EXPECT_NEAR(estimate.nsPerUnit(), 5000, 100);
}

TEST(FairShares, whoWasIdleGetsNoCreditForThePast) {
  Server server;
  std::vector<Client> clients = {client(address(1), "early", 3600 * kSecond_ns),
                                 client(address(2), "late", 3600 * kSecond_ns)};
  clients[1].next_ns = 60 * kSecond_ns;
  server.run(clients, 60 * kSecond_ns);
  const int64_t before_ns = clients[0].had_ns;
  server.run(clients, kSecond_ns);
  EXPECT_GE(clients[0].had_ns - before_ns, (kSecond_ns - kCredit_ns) / 2 - kPiece_ns);
}

TEST(FairShares, whoLeavesAndComesBackGainsNothing) {
  Server server;
  std::vector<Client> clients = {client(address(1), "quilt", 40 * kMs_ns),
                                 client(address(2), "0", 30 * kMs_ns)};
  for (int i = 1; i < 1000; ++i) {
    server.run(clients, 60 * kMs_ns);
    clients[1].claim.display = std::to_string(i);  // another display each time
    clients[1].claim.stream = "s" + std::to_string(i);
  }
  EXPECT_NEAR(double(clients[0].had_ns), double(clients[1].had_ns), 0.05 * 60 * 1e9);
}

TEST(FairShares, aSharedPictureCostsEachOfItsViewersLess) {
  Server server;
  std::vector<Client> clients = {client(address(1), "shared", 40 * kMs_ns),
                                 client(address(3), "own", 40 * kMs_ns)};
  clients[0].claim.payers.push_back(Payer(address(2)));
  server.run(clients, 30 * kSecond_ns);
  EXPECT_NEAR(double(clients[0].had_ns), 20 * 1e9, 1e9);
  EXPECT_NEAR(double(clients[1].had_ns), 10 * 1e9, 1e9);
}

TEST(FairShares, cancelledWorkHoldsNobodyUp) {
  Server server;
  std::vector<Client> clients = greedy(8);
  clients.push_back(client(address(1), "quilt", 40 * kMs_ns));
  server.run(clients, 10 * kSecond_ns);
  clients.erase(clients.begin(), clients.begin() + 8);  // their viewers have gone
  const int64_t before_ns = clients[0].had_ns;
  server.run(clients, 10 * kSecond_ns);
  EXPECT_EQ(clients[0].had_ns - before_ns, 10 * kSecond_ns);
}

// Names that are used once, as long as anybody likes.
TEST(FairShares, remembersFewOfThoseThatHaveGone) {
  if (lentHeapBytes() == 0) GTEST_SKIP() << "the C library does not say what it has lent";
  constexpr int kCount = 20000;
  constexpr uint64_t kMost_bytes = 1 << 20;
  const uint64_t before_bytes = lentHeapBytes();
  FairShares shares;
  const auto serve = [&shares](const Claim& claim) {
    shares.enter(claim);
    shares.begin(claim, kMs_ns);
    shares.finish(claim, kMs_ns, kMs_ns);
  };
  for (int i = 0; i < kCount; ++i) {
    const std::string name = "once" + std::to_string(i);
    serve({.payers = {Payer(address(1))}, .stream = name, .display = "quilt"});
    serve({.payers = {Payer(address(1))}, .stream = "s", .display = name});
    serve({.payers = {Payer(name)}, .stream = "s", .display = "quilt"});
  }
  EXPECT_LT(lentHeapBytes(), before_bytes + kMost_bytes);
}

}  // namespace
}  // namespace viewloom::fair_shares_test
