// SPDX-License-Identifier: Apache-2.0
// A library to be loaded before all others (LD_PRELOAD). While the file that VIEWLOOM_FAILING_NEW
// names is there, every so-many-th large allocation by operator new fails.
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

constexpr std::size_t kMayFail_bytes = std::size_t{32} * 1024;
constexpr unsigned kFailsEvery = 7;

bool mustFail(std::size_t size_bytes) {
  static std::atomic<unsigned> count = 0;
  if (size_bytes < kMayFail_bytes) return false;
  const char* const file = std::getenv("VIEWLOOM_FAILING_NEW");
  if (file == nullptr || access(file, F_OK) != 0) return false;
  return ++count % kFailsEvery == 0;
}

}  // namespace

void* operator new(std::size_t size_bytes) {
  void* const block = mustFail(size_bytes) ? nullptr : std::malloc(size_bytes > 0 ? size_bytes : 1);
  if (block == nullptr) throw std::bad_alloc();
  return block;
}

void operator delete(void* block) noexcept {
  std::free(block);
}

void operator delete(void* block, std::size_t) noexcept {
  std::free(block);
}
