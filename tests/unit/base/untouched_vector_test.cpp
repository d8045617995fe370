// SPDX-License-Identifier: Apache-2.0
#include "base/untouched_vector.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace viewloom::untouched_vector_test {
namespace {

constexpr size_t kCount = size_t{16} << 20;  // 64 MiB, which a system hands out page by page

// Pages of a vector's whole pages that it has been handed out.
size_t touchedPages(const auto& vector) {
  const auto page_bytes = size_t(sysconf(_SC_PAGESIZE));
  const auto begin = reinterpret_cast<uintptr_t>(vector.data());
  const uintptr_t first = (begin + page_bytes - 1) / page_bytes * page_bytes;
  const size_t count = (begin + vector.size() * sizeof vector[0] - first) / page_bytes;
  std::vector<unsigned char> states(count);
  EXPECT_EQ(mincore(reinterpret_cast<void*>(first), count * page_bytes, states.data()), 0);
  return size_t(std::ranges::count_if(states, [](unsigned char state) { return state & 1; }));
}

TEST(UntouchedVector, takesMemoryWithoutTouchingIt) {
  UntouchedVector<uint32_t> untouched;
  untouched.resize(kCount);
  EXPECT_LE(touchedPages(untouched), 2u) << "a sanitizer fills the first";
  untouched[kCount / 2] = 7;
  EXPECT_GE(touchedPages(untouched), 1u);
  const std::vector<uint32_t> cleared(kCount);
  EXPECT_GT(touchedPages(cleared), kCount * sizeof(uint32_t) / size_t(sysconf(_SC_PAGESIZE)) / 2);
}

TEST(UntouchedVector, keepsAndTakesValues) {
  UntouchedVector<uint32_t> vector = {1, 2, 3};
  vector.resize(1000);
  vector.push_back(4);
  vector.resize(1003, 5);
  const UntouchedVector<uint32_t> copy = vector;
  EXPECT_EQ(std::vector<uint32_t>(copy.begin(), copy.begin() + 3),
            (std::vector<uint32_t>{1, 2, 3}));
  EXPECT_EQ(std::vector<uint32_t>(copy.begin() + 1000, copy.end()),
            (std::vector<uint32_t>{4, 5, 5}));
}

}  // namespace
}  // namespace viewloom::untouched_vector_test
