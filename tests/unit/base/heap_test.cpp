// SPDX-License-Identifier: Apache-2.0
#include "base/heap.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace viewloom::heap_test {
namespace {

TEST(Heap, countsSmallAndMappedBlocksThatAreLent) {
  if (lentHeapBytes() == 0) GTEST_SKIP() << "the C library does not say what it has lent";
  const uint64_t before_bytes = lentHeapBytes();
  constexpr uint64_t kSmall_bytes = 50'000;
  constexpr uint64_t kMapped_bytes = uint64_t{64} << 20;
  std::optional<std::vector<uint8_t>> small(std::in_place, kSmall_bytes, uint8_t{1});
  const uint64_t with_small_bytes = lentHeapBytes();
  EXPECT_GE(with_small_bytes, before_bytes + kSmall_bytes);
  EXPECT_LT(with_small_bytes, before_bytes + 2 * kSmall_bytes);
  std::optional<std::vector<uint8_t>> mapped(std::in_place, kMapped_bytes, uint8_t{1});
  EXPECT_GE(lentHeapBytes(), with_small_bytes + kMapped_bytes);
  mapped.reset();
  small.reset();
  EXPECT_LT(lentHeapBytes(), before_bytes + kSmall_bytes);
}

}  // namespace
}  // namespace viewloom::heap_test
