// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sliced_bands.h"

#include <gtest/gtest.h>

#include <memory>

namespace viewloom::sliced_bands_test {
namespace {

using Bytes = std::vector<uint8_t>;

SharedBytes bytesOf(Bytes bytes) {
  return std::make_shared<const Bytes>(std::move(bytes));
}

TEST(SlicedBands, joinSlicesFromTheTopHoweverTheyCome) {
  BytePool pool(4);
  SlicedBands bands;
  const SlicedBands::Band band{.output = 1, .index = 3};
  const SlicedBands::Band other{.output = 0, .index = 3};
  EXPECT_EQ(bands.add(band, {.index = 2, .count = 3}, bytesOf({5}), pool), nullptr);
  EXPECT_EQ(bands.add(other, {.index = 0, .count = 2}, bytesOf({9}), pool), nullptr);
  EXPECT_EQ(bands.add(band, {.index = 0, .count = 3}, bytesOf({1, 2}), pool), nullptr);
  EXPECT_EQ(*bands.add(band, {.index = 1, .count = 3}, bytesOf({3, 4}), pool),
            (Bytes{1, 2, 3, 4, 5}));
  EXPECT_EQ(*bands.add(other, {.index = 1, .count = 2}, bytesOf({8}), pool), (Bytes{9, 8}));
}

TEST(SlicedBands, keepTheBytesOfAWholeBand) {
  BytePool pool(4);
  SlicedBands bands;
  const SharedBytes whole = bytesOf({1, 2});
  EXPECT_EQ(bands.add({}, {.index = 0, .count = 1}, whole, pool), whole);
}

}  // namespace
}  // namespace viewloom::sliced_bands_test
