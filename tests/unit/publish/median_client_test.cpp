// SPDX-License-Identifier: Apache-2.0
// The quality of a display whose readers belong to few clients.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "unit/publish/paced_readers.h"

namespace viewloom::test::median_client_test {
namespace {

constexpr int64_t kSecond = 1'000'000'000;
constexpr double kSlow = 300;
constexpr uint32_t kFinest = 24;
constexpr uint32_t kCoarse = 36;  // takes about as much as the slow line has

class WatcherOf final : public Watcher {
 public:
  explicit WatcherOf(std::string client) : client_(std::move(client)) {}
  std::string identity() const override { return client_; }

 private:
  const std::string client_;
};

class MedianClientTest : public testing::Test {
 protected:
  SubscriptionPtr watch(const std::string& client) {
    return join(broadcaster_, "s", quiltOf(2), std::make_shared<WatcherOf>(client), kAdapting);
  }
  void addReaders(const std::string& client, size_t count, double bytes_per_ms) {
    for (size_t i = 0; i < count; ++i) {
      readers_.push_back({.place = watch(client), .bytes_per_ms = bytes_per_ms});
    }
  }

  // Ten atlases a second, for so long.
  void run(int64_t duration_ns) {
    for (const int64_t end_ns = now_ns_ + duration_ns; now_ns_ < end_ns;) {
      auto bytes = codeAtlases(broadcaster_, "s", now_ns_, 0);
      for (PacedReader& reader : readers_) {
        reader.offer(bytes[reader.place->displayId()], now_ns_);
      }
      now_ns_ += kAtlasesApart_ns;
    }
  }
  DisplayCoding& coding() { return *broadcaster_.displays("s").front()->coding; }

  Broadcaster broadcaster_{{}};
  int64_t now_ns_ = 0;
  std::vector<PacedReader> readers_;
};

TEST_F(MedianClientTest, isNotOutvotedByOneThatHasManyFastConnections) {
  addReaders("anna", 1, kSlow);
  addReaders("ben", 1, kSlow);
  addReaders("greedy", 5, 0);
  run(3 * kSecond);
  EXPECT_GE(coding().qp(), kCoarse);
}

TEST_F(MedianClientTest, isNotOutvotedByOneThatHasManySlowConnections) {
  addReaders("anna", 1, 0);
  addReaders("ben", 1, 0);
  addReaders("greedy", 5, kSlow);
  run(3 * kSecond);
  EXPECT_EQ(coding().qp(), kFinest);
}

TEST_F(MedianClientTest, countsByTheMedianOfItsConnections) {
  addReaders("anna", 1, 0);
  addReaders("ben", 1, kSlow);
  addReaders("carl", 2, kSlow);
  addReaders("carl", 1, 0);
  run(3 * kSecond);
  EXPECT_GE(coding().qp(), kCoarse) << "two of three clients are slow";
  addReaders("carl", 1, 0);
  run(5 * kSecond);
  EXPECT_EQ(coding().qp(), kFinest) << "of four connections, two are fast";
}

// A browser that acknowledges nothing gets no third atlas: its line shows nothing.
TEST_F(MedianClientTest, isNotOutvotedByThoseThatAreSilent) {
  addReaders("anna", 1, kSlow);
  std::vector<SubscriptionPtr> silent;
  for (const char* const client : {"ben", "carl", "dora"}) {
    silent.push_back(watch(client));
    silent.back()->beginWrite(2 * adaptedBytes(kFinest), now_ns_);
    silent.back()->endAtlas(now_ns_ + 1);
  }
  run(3 * kSecond);
  EXPECT_GE(coding().qp(), kCoarse);
}

TEST_F(MedianClientTest, countsByWhatItsLineTakesWhereItReadsNothing) {
  addReaders("anna", 1, 0);
  std::vector<SubscriptionPtr> stuck;
  for (const char* const client : {"ben", "carl"}) {
    stuck.push_back(watch(client));
    stuck.back()->beginWrite(adaptedBytes(kFinest), now_ns_);
  }
  run(3 * kSecond);
  EXPECT_GE(coding().qp(), kCoarse);
}

TEST_F(MedianClientTest, getsTheFinestStandingAtlasBesideOneWhoseConnectionsAreStuck) {
  addReaders("anna", 1, kSlow);
  run(3 * kSecond);
  ASSERT_GE(coding().qp(), kCoarse);
  now_ns_ += kSecond;
  std::vector<SubscriptionPtr> stuck;
  for (int i = 0; i < 3; ++i) {
    stuck.push_back(watch("greedy"));
    stuck.back()->beginWrite(adaptedBytes(kFinest), now_ns_);
  }
  EXPECT_TRUE(coding().wantsFiner(now_ns_));
}

}  // namespace
}  // namespace viewloom::test::median_client_test
