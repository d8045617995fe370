// SPDX-License-Identifier: Apache-2.0
#include "base/heap.h"

#include <algorithm>
#include <cstdlib>  // declares __GLIBC__
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "base/processor_count.h"

namespace viewloom {

void keepFreedMemory() {
#ifdef __GLIBC__
  // Larger blocks are mapped one by one, and go back as soon as they are free: glibc returns the
  // free end of the first heap only. Pieces of messages are smaller, and planes wait in a pool.
  constexpr int kMappedAlone_bytes = 4 << 20;
  // So much may lie free before the end of the heap goes back: a few of the largest frames.
  constexpr int kKept_bytes = 256 << 20;
  // Each heap has pages of its own that are in use only in part. glibc makes eight for each core.
  constexpr unsigned kHeapsPerCore = 2;
  constexpr unsigned kHeapsMin = 4;
  mallopt(M_MMAP_THRESHOLD, kMappedAlone_bytes);
  mallopt(M_TRIM_THRESHOLD, kKept_bytes);
  mallopt(M_ARENA_MAX, int(std::max(kHeapsMin, kHeapsPerCore * processorCount())));
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
