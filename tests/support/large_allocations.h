// SPDX-License-Identifier: Apache-2.0
// Counts heap allocations above 64 KiB in the whole process, C libraries included.
#pragma once

#include <cstddef>
#include <cstdint>

namespace viewloom::test {

inline constexpr size_t kLargeAllocation_bytes = size_t{64} * 1024;

// False under a sanitizer, whose own allocator stands where this would.
bool countsLargeAllocations();

// Since the process began. Thread-safety: any thread.
uint64_t largeAllocationCount();

}  // namespace viewloom::test
