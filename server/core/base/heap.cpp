// SPDX-License-Identifier: Apache-2.0
#include "base/heap.h"

#include <cstdlib>  // declares __GLIBC__
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace viewloom {

void keepFreedMemory() {
#ifdef __GLIBC__
  // Larger blocks are mapped one by one; 32 MiB is the most that glibc takes (HEAP_MAX_SIZE / 2).
  constexpr int kMappedAlone_bytes = 32 << 20;
  // So much may lie free before the end of the heap goes back: a few of the largest frames.
  constexpr int kKept_bytes = 256 << 20;
  mallopt(M_MMAP_THRESHOLD, kMappedAlone_bytes);
  mallopt(M_TRIM_THRESHOLD, kKept_bytes);
#endif
}

void returnFreedMemory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

uint64_t lentHeapBytes() {
#ifdef __GLIBC__
  const struct mallinfo2 heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
#else
  return 0;
#endif
}

}  // namespace viewloom
