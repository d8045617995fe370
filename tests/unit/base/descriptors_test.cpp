// SPDX-License-Identifier: Apache-2.0
#include "base/descriptors.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace viewloom::descriptors_test {
namespace {

TEST(Descriptors, givesWhatIsWantedWhereThereIsRoom) {
  const ConnectionShares wanted{.grpc = 1024, .http = 1280};
  EXPECT_EQ(shareDescriptors(1024 + 1280 + kOwnDescriptors, wanted), wanted);
  EXPECT_EQ(shareDescriptors(uint64_t{1} << 40, wanted), wanted);
}

TEST(Descriptors, keepsItsOwnAndSharesTheRest) {
  const ConnectionShares wanted{.grpc = 1024, .http = 3072};
  EXPECT_EQ(shareDescriptors(1024, wanted), (ConnectionShares{.grpc = 192, .http = 576}));
  for (uint64_t limit = kOwnDescriptors + 2; limit < 5000; limit += 7) {
    const ConnectionShares shares = shareDescriptors(limit, wanted);
    EXPECT_LE(uint64_t{shares.grpc} + shares.http + kOwnDescriptors, limit + 1) << limit;
  }
}

TEST(Descriptors, leavesEachPortOneConnectionWhereThereIsNoRoom) {
  EXPECT_EQ(shareDescriptors(64, {.grpc = 1024, .http = 1280}),
            (ConnectionShares{.grpc = 1, .http = 1}));
}

TEST(Descriptors, raisesTheLimitAsFarAsItMay) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  rlimit lower = before;
  lower.rlim_cur = 300;
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &lower), 0);
  EXPECT_EQ(descriptorLimit(), 300u);
  EXPECT_EQ(raiseDescriptorLimit(), before.rlim_max);
  EXPECT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
}

}  // namespace
}  // namespace viewloom::descriptors_test
