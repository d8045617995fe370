// SPDX-License-Identifier: Apache-2.0
#include "pipeline/build_charge.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>

#include "base/thread_time.h"
#include "base/worker_pool.h"

namespace viewloom::build_charge_test {
namespace {

constexpr int64_t kPredicted_ns = 20'000'000;
constexpr int64_t kMuch_ns = 150'000'000;  // more than kCredit_ns, less than is paid at most

Claim claimOf(const std::string& payer) {
  return {.payers = {Payer(payer)}, .stream = payer};
}

class BuildChargeTest : public testing::Test {
 protected:
  // Both have begun, and none has credit from the time before.
  BuildChargeTest() {
    for (const char* payer : {"builder", "other"}) pay(payer, 10 * kCredit_ns);
  }
  void pay(const std::string& payer, int64_t time_ns) {
    shares_.begin(claimOf(payer), time_ns);
    shares_.finish(claimOf(payer), time_ns, time_ns);
  }
  bool isBuilderFirst() const { return shares_.goesBefore(claimOf("builder"), claimOf("other")); }

  Metrics metrics_;
  FairShares shares_;
  BuildCharge charge_{shares_, metrics_, claimOf("builder"), kPredicted_ns};
};

TEST_F(BuildChargeTest, costsNothingWhileItWaits) {
  std::this_thread::sleep_for(std::chrono::nanoseconds(kMuch_ns));
  EXPECT_LT(charge_.settle(), kMuch_ns / 2);
  pay("other", kMuch_ns / 2);
  EXPECT_TRUE(isBuilderFirst()) << "it pays for the time in which others were served";
}

TEST_F(BuildChargeTest, costsTheTimeOfTheDevice) {
  charge_.events([] { return false; }).on_piece({.predicted_ns = 1, .measured_ns = kMuch_ns});
  EXPECT_GE(charge_.settle(), kMuch_ns);
  pay("other", kMuch_ns / 2);
  EXPECT_FALSE(isBuilderFirst());
}

TEST_F(BuildChargeTest, costsTheTimeOfWorkersThatHelp) {
  WorkerPool workers(3);
  workers.forEach(6, [](uint32_t, uint32_t) {
    const int64_t end_ns = threadTimeNs() + kMuch_ns / 6;
    while (threadTimeNs() < end_ns) {
    }
  });
  EXPECT_GE(charge_.settle(), kMuch_ns);
}

TEST_F(BuildChargeTest, isPaidOnce) {
  EXPECT_EQ(charge_.settle(), charge_.settle());
}

}  // namespace
}  // namespace viewloom::build_charge_test
