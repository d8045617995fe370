// SPDX-License-Identifier: Apache-2.0
#include "bench/visit_counter.h"

#include <gtest/gtest.h>

namespace viewloom::bench::visit_counter_test {
namespace {

// Two tiles side by side, two rows of them, each 12x10 px: blocks end with their tile.
AtlasLayout twoByTwo() {
  AtlasLayout layout;
  layout.columns = 2;
  layout.rows = 2;
  layout.tile_size_px = {12, 10};
  layout.size_px = {24, 20};
  return layout;
}

TEST(VisitCounter, findsTheBlockOfOneViewThatLooksAtMost) {
  std::vector<abi::RayRecord> records(size_t{24} * 20);
  for (abi::RayRecord& record : records) record.visits = 1;
  // 2x2 px of 100 visits around the corner of the four tiles: of each block they are one.
  for (const size_t px : {9U * 24 + 11, 9U * 24 + 12, 10U * 24 + 11, 10U * 24 + 12}) {
    records[px].visits = 100;
  }
  VisitCounter counter(twoByTwo());
  counter.addRows(std::span(records).first(size_t{24} * 7));
  counter.addRows(std::span(records).subspan(size_t{24} * 7));
  const Visits visits = counter.visits();
  EXPECT_DOUBLE_EQ(visits.mean, (476 + 4 * 100) / 480.0);
  EXPECT_EQ(visits.p99, 1U);
  EXPECT_EQ(visits.max, 100U);
  // The lower right tile's first block is whole: 63 others.
  EXPECT_EQ(visits.slowest_block_sum, 163U);
}

TEST(VisitCounter, saysWhatOneRayInAHundredExceeds) {
  AtlasLayout layout;
  layout.tile_size_px = layout.size_px = {200, 1};
  std::vector<abi::RayRecord> records(200);
  for (uint32_t i = 0; i < 200; ++i) records[i].visits = i + 1;
  VisitCounter counter(layout);
  counter.addRows(records);
  EXPECT_EQ(counter.visits().p99, 199U);
  EXPECT_EQ(counter.visits().slowest_block_sum, 193U + 194 + 195 + 196 + 197 + 198 + 199 + 200);
}

}  // namespace
}  // namespace viewloom::bench::visit_counter_test
