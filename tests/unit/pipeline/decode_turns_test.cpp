// SPDX-License-Identifier: Apache-2.0
#include "pipeline/decode_turns.h"

#include <gtest/gtest.h>

#include <string>

namespace viewloom::decode_turns_test {
namespace {

FrameOrigin from(const std::string& publisher, const std::string& stream) {
  return {.stream = stream, .publisher = Payer(publisher)};
}

TEST(DecodeTurns, beginWithTheOldest) {
  const FairShares shares;
  EXPECT_EQ(turnToDecode(shares, {from("10.0.0.1", "a"), from("10.0.0.2", "b")}), 0U);
  EXPECT_EQ(turnToDecode(shares, {from("10.0.0.2", "b")}), 0U);
}

// Fifteen streams of one publisher are one publisher.
TEST(DecodeTurns, goToThePublisherWithTheSmallestShare) {
  FairShares shares;
  payForDecoding(shares, from("10.0.0.1", "a"), 100'000'000);
  EXPECT_EQ(turnToDecode(shares, {from("10.0.0.1", "a"), from("10.0.0.1", "another"),
                                  from("10.0.0.2", "b")}),
            2U);
}

TEST(DecodeTurns, goToTheStreamWithTheSmallestShareOfAPublisher) {
  FairShares shares;
  payForDecoding(shares, from("10.0.0.1", "a"), 100'000'000);
  EXPECT_EQ(turnToDecode(shares, {from("10.0.0.1", "a"), from("10.0.0.1", "another")}), 1U);
}

}  // namespace
}  // namespace viewloom::decode_turns_test
