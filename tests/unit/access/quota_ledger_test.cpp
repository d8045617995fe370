// SPDX-License-Identifier: Apache-2.0
#include "access/quota_ledger.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace viewloom::quota_ledger_test {

using testing::HasSubstr;
using testing::Not;

constexpr auto kExhausted = absl::StatusCode::kResourceExhausted;
constexpr int64_t kSecond_ns = 1'000'000'000;

Identity identityOf(const std::string& id, Quota quota) {
  Identity identity{.id = id, .proof = Proof::kToken, .rights = allRights()};
  identity.rights.quota = quota;
  return identity;
}

std::string textOf(const absl::Status& status) {
  return std::string(status.message());
}

class QuotaLedgerTest : public testing::Test {
 protected:
  ManualClock clock_;
  QuotaLedger ledger_{clock_};
};

TEST_F(QuotaLedgerTest, grantsEverythingWithoutAQuota) {
  const Identity identity = identityOf("free", {});
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(ledger_.holdConnection(identity).value(), nullptr);
    EXPECT_EQ(ledger_.holdStream(identity, std::to_string(i)).value(), nullptr);
  }
  ledger_.noteBytes(identity, uint64_t{1} << 40);
  EXPECT_TRUE(ledger_.checkRates(identity).ok());
}

TEST_F(QuotaLedgerTest, countsConnectionsUntilTheyEnd) {
  const Identity identity = identityOf("wall", {.connections = 2});
  const QuotaPartPtr first = ledger_.holdConnection(identity).value();
  QuotaPartPtr second = ledger_.holdConnection(identity).value();
  const absl::Status refusal = ledger_.holdConnection(identity).status();
  EXPECT_EQ(refusal.code(), kExhausted);
  EXPECT_THAT(textOf(refusal), HasSubstr("a further connection was asked for; accepted are 2 at a "
                                         "time (limit connections of the access token of "
                                         "\"wall\"), and there are 2"));
  EXPECT_TRUE(ledger_.holdConnection(identityOf("other", {.connections = 1})).ok());
  second.reset();
  EXPECT_TRUE(ledger_.holdConnection(identity).ok());
}

TEST_F(QuotaLedgerTest, countsAStreamOnceForItsNextPublisher) {
  const Identity identity = identityOf("camera", {.streams = 1});
  QuotaPartPtr first = ledger_.holdStream(identity, "a").value();
  QuotaPartPtr next = ledger_.holdStream(identity, "a").value();
  const absl::Status refusal = ledger_.holdStream(identity, "b").status();
  EXPECT_EQ(refusal.code(), kExhausted);
  EXPECT_EQ(fieldOf(refusal), "stream");
  first.reset();
  EXPECT_FALSE(ledger_.holdStream(identity, "b").ok());
  next.reset();
  EXPECT_TRUE(ledger_.holdStream(identity, "b").ok());
}

TEST_F(QuotaLedgerTest, grantsNothingWhereNothingIsAllowed) {
  const absl::Status refusal =
      ledger_.holdStream(identityOf("camera", {.streams = 0}), "a").status();
  EXPECT_THAT(textOf(refusal), HasSubstr("accepted are 0 at a time"));
  EXPECT_THAT(textOf(refusal), Not(HasSubstr("End one")));
}

TEST_F(QuotaLedgerTest, countsDisplaysThatDiffer) {
  const Identity identity = identityOf("wall", {.displays = 1});
  const QuotaPartPtr first = ledger_.holdDisplay(identity, {.key = "a"}, nullptr).value();
  EXPECT_TRUE(ledger_.holdDisplay(identity, {.key = "a"}, nullptr).ok());
  EXPECT_EQ(ledger_.holdDisplay(identity, {.key = "b"}, nullptr).status().code(), kExhausted);
  EXPECT_TRUE(ledger_.holdDisplay(identity, {.key = "b"}, first.get()).ok());
  const QuotaPartPtr also_first = ledger_.holdDisplay(identity, {.key = "a"}, nullptr).value();
  EXPECT_FALSE(ledger_.holdDisplay(identity, {.key = "b"}, first.get()).ok());
}

TEST_F(QuotaLedgerTest, saysWhichDisplayFits) {
  const Identity identity = identityOf("wall", {.pixels_per_s = 4'000'000});
  const DisplayUse use{.key = "a", .pixels = 1'000'000, .rate_hz = 16};
  const absl::Status refusal = ledger_.holdDisplay(identity, use, nullptr).status();
  EXPECT_EQ(refusal.code(), kExhausted);
  EXPECT_THAT(textOf(refusal), HasSubstr("asks for 16000000 pixels a second (1000000 in each "
                                         "picture); 4000000 of 4000000 are left"));
  EXPECT_THAT(textOf(refusal), HasSubstr("at up to 4.0 pictures a second "
                                         "(temporal.output_rate_hz), or with 50 % of its width"));
  const QuotaPartPtr fits =
      ledger_.holdDisplay(identity, {.key = "a", .pixels = 1'000'000, .rate_hz = 4}, nullptr)
          .value();
  EXPECT_NE(fits, nullptr);
  const absl::Status full =
      ledger_.holdDisplay(identity, {.key = "b", .pixels = 100}, nullptr).status();
  EXPECT_THAT(textOf(full), HasSubstr("0 of 4000000 are left"));
  EXPECT_THAT(textOf(full), HasSubstr("Nothing smaller fits"));
  EXPECT_TRUE(ledger_.holdDisplay(identity, {.key = "b", .pixels = 100}, fits.get()).ok());
}

TEST_F(QuotaLedgerTest, letsARateBeExceededForAMoment) {
  const Identity identity = identityOf("camera", {.bytes_per_s = 1000});
  for (int second = 0; second < 100; ++second) {
    ledger_.noteBytes(identity, 1000);
    clock_.advance(kSecond_ns);
    ASSERT_TRUE(ledger_.checkRates(identity).ok()) << second;
  }
  ledger_.noteBytes(identity, 1000 * QuotaLedger::kBurst_s);
  EXPECT_TRUE(ledger_.checkRates(identity).ok());
  ledger_.noteBytes(identity, 1);
  const absl::Status refusal = ledger_.checkRates(identity);
  EXPECT_EQ(refusal.code(), kExhausted);
  EXPECT_THAT(textOf(refusal), HasSubstr("5001 bytes were used within 0.0 s; accepted are 1000 a "
                                         "second (limit bytes_per_s"));
  EXPECT_FALSE(ledger_.checkRates(identity).ok());
  clock_.advance(kSecond_ns);
  EXPECT_TRUE(ledger_.checkRates(identity).ok());
}

TEST_F(QuotaLedgerTest, endsOneCallForWhatAllHaveUsed) {
  const Identity identity = identityOf("camera", {.bytes_per_s = 1000});
  ledger_.noteBytes(identity, 1'000'000);
  EXPECT_FALSE(ledger_.endIfOver(identity).ok());
  EXPECT_TRUE(ledger_.endIfOver(identity).ok());
  ledger_.noteBytes(identity, 1000 * QuotaLedger::kBurst_s);
  EXPECT_TRUE(ledger_.endIfOver(identity).ok());
  ledger_.noteBytes(identity, 1);
  EXPECT_FALSE(ledger_.endIfOver(identity).ok());
}

// Else whoever ends a call could use more at once by a new one.
TEST_F(QuotaLedgerTest, letsNoCallBeginUntilTheRateHasFallen) {
  const Identity identity = identityOf("camera", {.bytes_per_s = 1000});
  ledger_.noteBytes(identity, 20'000);
  EXPECT_FALSE(ledger_.endIfOver(identity).ok());
  EXPECT_FALSE(ledger_.checkRates(identity).ok());
  clock_.advance(14 * kSecond_ns);
  EXPECT_FALSE(ledger_.checkRates(identity).ok());
  EXPECT_TRUE(ledger_.endIfOver(identity).ok()) << "others stay meanwhile";
  clock_.advance(kSecond_ns);
  EXPECT_TRUE(ledger_.checkRates(identity).ok());
  ledger_.noteBytes(identity, 1);
  EXPECT_FALSE(ledger_.endIfOver(identity).ok());
}

TEST_F(QuotaLedgerTest, countsAnAtlasOnceForAllWhoSeeIt) {
  const Identity identity = identityOf("wall", {.pixels_per_s = 1000});
  const QuotaPartPtr one = ledger_.holdDisplay(identity, {.key = "a"}, nullptr).value();
  const QuotaPartPtr other = ledger_.holdDisplay(identity, {.key = "a"}, nullptr).value();
  for (uint64_t sequence = 1; sequence <= 5; ++sequence) {
    one->noteAtlas(sequence, 1000);
    other->noteAtlas(sequence, 1000);
  }
  EXPECT_TRUE(ledger_.checkRates(identity).ok());
  other->noteAtlas(6, 1000);
  EXPECT_THAT(textOf(ledger_.checkRates(identity)), HasSubstr("6000 pixels were used"));
}

TEST_F(QuotaLedgerTest, keepsWhatWasUsedByThoseWhoLeft) {
  const Identity identity = identityOf("wall", {.displays = 9, .pixels_per_s = 1000});
  ledger_.holdDisplay(identity, {.key = "a"}, nullptr).value()->noteAtlas(1, 6000);
  // The accounts are looked through when one more comes.
  EXPECT_TRUE(ledger_.holdStream(identityOf("other", {.streams = 1}), "a").ok());
  EXPECT_FALSE(ledger_.checkRates(identity).ok());
  clock_.advance(7 * kSecond_ns);
  EXPECT_TRUE(ledger_.checkRates(identity).ok());
}

}  // namespace viewloom::quota_ledger_test
