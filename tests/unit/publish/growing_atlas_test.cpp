// SPDX-License-Identifier: Apache-2.0
#include "publish/growing_atlas.h"

#include <gtest/gtest.h>

#include <thread>

#include "unit/publish/watcher.h"

namespace viewloom::test::growing_atlas_test {
namespace {

using State = GrowingAtlas::State;

struct Told : AtlasReader {
  void noteGrowth() override { ++count; }
  std::atomic<int> count = 0;
};

SharedBytes bytesOf(size_t count) {
  return std::make_shared<std::vector<uint8_t>>(count, uint8_t{7});
}

class GrowingAtlasTest : public testing::Test {
 protected:
  const std::shared_ptr<Told> told_ = std::make_shared<Told>();
  GrowingAtlas growing_{begunAtlas(1, 1, 3)};
};

TEST_F(GrowingAtlasTest, givesBandsInARowOnly) {
  growing_.put(1, bytesOf(10));
  EXPECT_EQ(growing_.readyCount({.first = 0, .last = 3}), 0U);
  EXPECT_EQ(growing_.readyCount({.first = 1, .last = 3}), 1U);
  growing_.put(0, bytesOf(10));
  EXPECT_EQ(growing_.readyCount({.first = 0, .last = 3}), 2U);
  EXPECT_EQ(growing_.readyCount({.first = 0, .last = 1}), 1U);
}

TEST_F(GrowingAtlasTest, givesFewBytesOnlyWhereNoneFollow) {
  growing_.put(0, bytesOf(10));
  growing_.put(1, bytesOf(9));
  EXPECT_EQ(growing_.readyCount({.first = 0, .last = 3, .bytes_min = 20}), 0U);
  EXPECT_EQ(growing_.readyCount({.first = 0, .last = 3, .bytes_min = 19}), 2U);
  EXPECT_EQ(growing_.readyCount({.first = 0, .last = 2, .bytes_min = 20}), 2U);
}

TEST_F(GrowingAtlasTest, tellsAReaderOnceThatThereIsEnough) {
  const BandsWanted wanted{.first = 0, .last = 3, .bytes_min = 20};
  EXPECT_EQ(growing_.await(wanted, told_), 0U);
  EXPECT_EQ(growing_.await(wanted, told_), 0U) << "who asks twice is told once";
  growing_.put(0, bytesOf(10));
  growing_.put(2, bytesOf(10));
  EXPECT_EQ(told_->count, 0) << "there are two, but not in a row";
  growing_.put(1, bytesOf(10));
  EXPECT_EQ(told_->count, 1);
  EXPECT_EQ(growing_.await(wanted, told_), 3U);
  growing_.complete({});
  EXPECT_EQ(told_->count, 1) << "nothing was awaited";
}

TEST_F(GrowingAtlasTest, tellsItsOutcomeOnceItIsWhole) {
  for (size_t band = 0; band < 3; ++band) growing_.put(band, bytesOf(1));
  EXPECT_EQ(growing_.await({.first = 3, .last = 3}, told_), 0U);
  EXPECT_EQ(growing_.state(), State::kGrowing);
  const AtlasPtr whole = growing_.complete({.times = {.trace_ns = 5}, .coverage = {.hit = 2}});
  EXPECT_EQ(told_->count, 1);
  EXPECT_EQ(growing_.state(), State::kWhole);
  EXPECT_EQ(whole->times.trace_ns, 5);
  EXPECT_EQ(whole->coverage.hit, 2U);
  EXPECT_EQ(whole.get(), &growing_.atlas()) << "no second atlas is made";
  growing_.abandon();
  EXPECT_EQ(growing_.state(), State::kWhole);
}

TEST_F(GrowingAtlasTest, tellsThatItIsAbandoned) {
  growing_.await({.first = 0, .last = 1}, told_);
  growing_.abandon();
  EXPECT_EQ(told_->count, 1);
  EXPECT_EQ(growing_.state(), State::kAbandoned);
}

TEST_F(GrowingAtlasTest, forgetsReadersThatAreGone) {
  growing_.await({.first = 0, .last = 1}, std::make_shared<Told>());
  growing_.put(0, bytesOf(1));
  EXPECT_EQ(growing_.readyCount({.first = 0, .last = 1}), 1U);
}

TEST(GrowingAtlas, isReadWhileThreadsPackIt) {
  constexpr size_t kBandCount = 200;
  GrowingAtlas growing(begunAtlas(1, 1, kBandCount));
  const auto told = std::make_shared<Told>();
  const std::jthread evens([&] {
    for (size_t band = 0; band < kBandCount; band += 2) growing.put(band, bytesOf(band + 1));
  });
  const std::jthread odds([&] {
    for (size_t band = 1; band < kBandCount; band += 2) growing.put(band, bytesOf(band + 1));
  });
  size_t band = 0;
  while (band < kBandCount) {
    const int told_count = told->count;
    const size_t count = growing.await({.first = band, .last = kBandCount}, told);
    for (size_t i = band; i < band + count; ++i) {
      ASSERT_EQ(growing.atlas().bands[i].bytes->size(), i + 1);
    }
    band += count;
    while (count == 0 && told->count == told_count) std::this_thread::yield();
  }
}

}  // namespace
}  // namespace viewloom::test::growing_atlas_test
