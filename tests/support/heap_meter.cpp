// SPDX-License-Identifier: Apache-2.0
#include "support/heap_meter.h"

#include <malloc.h>
#include <atomic>
#include <cerrno>
#include <cstddef>

namespace viewloom::test {
namespace {

std::atomic<bool> is_measuring = false;
std::atomic<int64_t> grown_bytes = 0;
std::atomic<int64_t> peak_bytes = 0;

}  // namespace

HeapMeter::HeapMeter() {
  grown_bytes = 0;
  peak_bytes = 0;
  is_measuring = true;
}

HeapMeter::~HeapMeter() {
  is_measuring = false;
}

int64_t HeapMeter::grownBytes() const {
  return grown_bytes;
}

int64_t HeapMeter::peakBytes() const {
  return peak_bytes;
}

}  // namespace viewloom::test

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

bool viewloom::test::HeapMeter::isAvailable() {
  return false;
}

#else

bool viewloom::test::HeapMeter::isAvailable() {
  return true;
}

namespace {

using viewloom::test::grown_bytes;
using viewloom::test::is_measuring;
using viewloom::test::peak_bytes;

// The real size of a block: the same when it comes and when it goes.
void add(void* block) {
  if (!is_measuring.load(std::memory_order_relaxed) || block == nullptr) return;
  const auto size_bytes = int64_t(malloc_usable_size(block));
  const int64_t now_bytes = grown_bytes.fetch_add(size_bytes) + size_bytes;
  int64_t most_bytes = peak_bytes;
  while (now_bytes > most_bytes && !peak_bytes.compare_exchange_weak(most_bytes, now_bytes)) {
  }
}

void remove(void* block) {
  if (!is_measuring.load(std::memory_order_relaxed) || block == nullptr) return;
  grown_bytes -= int64_t(malloc_usable_size(block));
}

}  // namespace

// Definitions in a program stand before glibc's for every library it loads; glibc offers its own
// under these names for exactly that.
extern "C" {
void* __libc_malloc(size_t size_bytes);
void* __libc_calloc(size_t count, size_t size_bytes);
void* __libc_realloc(void* block, size_t size_bytes);
void* __libc_memalign(size_t alignment_bytes, size_t size_bytes);
void __libc_free(void* block);

void* malloc(size_t size_bytes) {
  void* const block = __libc_malloc(size_bytes);
  add(block);
  return block;
}

void* calloc(size_t count, size_t size_bytes) {
  void* const block = __libc_calloc(count, size_bytes);
  add(block);
  return block;
}

void* realloc(void* block, size_t size_bytes) {
  remove(block);
  void* const moved = __libc_realloc(block, size_bytes);
  // A block that cannot grow stays.
  add(moved == nullptr && size_bytes > 0 ? block : moved);
  return moved;
}

void* aligned_alloc(size_t alignment_bytes, size_t size_bytes) {
  void* const block = __libc_memalign(alignment_bytes, size_bytes);
  add(block);
  return block;
}

void* memalign(size_t alignment_bytes, size_t size_bytes) {
  return aligned_alloc(alignment_bytes, size_bytes);
}

int posix_memalign(void** block, size_t alignment_bytes, size_t size_bytes) {
  *block = aligned_alloc(alignment_bytes, size_bytes);
  return *block == nullptr ? ENOMEM : 0;
}

void free(void* block) {
  remove(block);
  __libc_free(block);
}
}

#endif
