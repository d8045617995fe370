// SPDX-License-Identifier: Apache-2.0
// How much more memory the heap of the whole process lends than before, C libraries included, and
// on a device whose memory is the CPU's that memory, too.
#pragma once

#include <cstdint>

namespace viewloom::test {

// From its construction on; one at a time. Not in a program with support/large_allocations.h.
// Thread-safety: methods may be called from any thread.
class HeapMeter {
 public:
  HeapMeter();
  ~HeapMeter();
  HeapMeter(const HeapMeter&) = delete;
  HeapMeter& operator=(const HeapMeter&) = delete;

  // False under a sanitizer, whose own allocator stands where this would.
  static bool isAvailable();

  int64_t grownBytes() const;  // until now
  int64_t peakBytes() const;   // the most it was
};

}  // namespace viewloom::test
