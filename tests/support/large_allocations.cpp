// SPDX-License-Identifier: Apache-2.0
#include "support/large_allocations.h"

#include <atomic>
#include <cerrno>
#include <cstdlib>

namespace viewloom::test {
namespace {

std::atomic<uint64_t> large_count = 0;

}  // namespace

uint64_t largeAllocationCount() {
  return large_count;
}

}  // namespace viewloom::test

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

bool viewloom::test::countsLargeAllocations() {
  return false;
}

#else

bool viewloom::test::countsLargeAllocations() {
  return true;
}

namespace {

void note(size_t size_bytes) {
  if (size_bytes > viewloom::test::kLargeAllocation_bytes) ++viewloom::test::large_count;
}

}  // namespace

// Definitions in a program stand before glibc's for every library it loads; glibc offers its own
// under these names for exactly that.
extern "C" {
void* __libc_malloc(size_t size_bytes);
void* __libc_calloc(size_t count, size_t size_bytes);
void* __libc_realloc(void* block, size_t size_bytes);
void* __libc_memalign(size_t alignment_bytes, size_t size_bytes);

void* malloc(size_t size_bytes) {
  note(size_bytes);
  return __libc_malloc(size_bytes);
}

void* calloc(size_t count, size_t size_bytes) {
  note(count * size_bytes);
  return __libc_calloc(count, size_bytes);
}

void* realloc(void* block, size_t size_bytes) {
  note(size_bytes);
  return __libc_realloc(block, size_bytes);
}

void* aligned_alloc(size_t alignment_bytes, size_t size_bytes) {
  note(size_bytes);
  return __libc_memalign(alignment_bytes, size_bytes);
}

int posix_memalign(void** block, size_t alignment_bytes, size_t size_bytes) {
  note(size_bytes);
  *block = __libc_memalign(alignment_bytes, size_bytes);
  return *block == nullptr ? ENOMEM : 0;
}
}

#endif
