// SPDX-License-Identifier: Apache-2.0
#include "support/failing_allocations.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace viewloom::test {
namespace {

std::atomic<int64_t> left_count = -1;  // until one fails; negative = none will
std::atomic<bool> has_failed = false;

bool mustFail(size_t size_bytes) {
  if (size_bytes < kMayFail_bytes || left_count < 0) return false;
  const bool fails = left_count.fetch_sub(1) == 0;
  if (fails) has_failed = true;
  return fails;
}

}  // namespace

void failAllocation(uint64_t rank) {
  has_failed = false;
  left_count = int64_t(rank);
}

bool stopFailing() {
  left_count = -1;
  return has_failed;
}

}  // namespace viewloom::test

// Definitions in a program stand before those of the C++ library.
void* operator new(size_t size_bytes) {
  void* const block = viewloom::test::mustFail(size_bytes) ? nullptr : std::malloc(size_bytes);
  if (block == nullptr) throw std::bad_alloc();
  return block;
}
void operator delete(void* block) noexcept {
  std::free(block);
}
void operator delete(void* block, size_t) noexcept {
  std::free(block);
}
