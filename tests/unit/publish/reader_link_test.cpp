// SPDX-License-Identifier: Apache-2.0
#include "publish/reader_link.h"

#include <gtest/gtest.h>

namespace viewloom::test::reader_link_test {
namespace {

constexpr int64_t kMs = 1'000'000;

void deliver(ReaderLink& link, uint64_t bytes, int64_t from_ms, int64_t to_ms) {
  link.beginWrite(bytes, from_ms * kMs);
  link.endAtlas(to_ms * kMs);
}

TEST(ReaderLinkTest, knowsNoLimitOfASocketThatIsSeldomBusy) {
  ReaderLink link;
  EXPECT_FALSE(link.bytesPerSecond(0));
  for (int64_t ms = 0; ms < 1000; ms += 50) deliver(link, 100'000, ms, ms + 1);
  EXPECT_FALSE(link.bytesPerSecond(1000 * kMs));
}

TEST(ReaderLinkTest, measuresWhileTheSocketIsBusy) {
  ReaderLink link;
  for (int64_t ms = 0; ms < 300; ms += 60) deliver(link, 100'000, ms, ms + 40);
  EXPECT_NEAR(*link.bytesPerSecond(300 * kMs), 2.5e6, 1);
}

TEST(ReaderLinkTest, addsTheMessagesOfAnAtlas) {
  ReaderLink link;
  link.beginWrite(60'000, 0);
  link.endWrite(10 * kMs);
  // Waits for the encoder.
  link.beginWrite(40'000, 500 * kMs);
  link.endWrite(590 * kMs);
  link.endAtlas(590 * kMs);
  EXPECT_NEAR(*link.bytesPerSecond(600 * kMs), 1e6, 1);
}

TEST(ReaderLinkTest, tellsByOneAtlasThatTakesLong) {
  ReaderLink link;
  for (int64_t ms = 0; ms < 600; ms += 30) deliver(link, 300'000, ms, ms + 20);
  deliver(link, 300'000, 600, 750);
  EXPECT_NEAR(*link.bytesPerSecond(750 * kMs), 2e6, 1);
}

TEST(ReaderLinkTest, tellsByAnAtlasThatIsNotThrough) {
  ReaderLink link;
  link.beginWrite(300'000, 0);
  EXPECT_TRUE(link.isWriting());
  EXPECT_NEAR(*link.bytesPerSecond(300 * kMs), 1e6, 1);
  EXPECT_NEAR(*link.bytesPerSecond(3000 * kMs), 1e5, 1);
}

TEST(ReaderLinkTest, forgetsAfterASecond) {
  ReaderLink link;
  deliver(link, 300'000, 0, 300);
  EXPECT_EQ(link.recentBytes(1200 * kMs), 300'000u);
  EXPECT_FALSE(link.bytesPerSecond(1400 * kMs));
  EXPECT_EQ(link.recentBytes(1400 * kMs), 0u);
}

TEST(ReaderLinkTest, ignoresAnEndWithoutABegin) {
  ReaderLink link;
  link.endWrite(kMs);
  link.endAtlas(2 * kMs);
  EXPECT_FALSE(link.bytesPerSecond(3 * kMs));
}

}  // namespace
}  // namespace viewloom::test::reader_link_test
