// SPDX-License-Identifier: Apache-2.0
// Lets a large allocation by operator new fail in the whole process, as on a machine whose memory
// has run out.
#pragma once

#include <cstddef>
#include <cstdint>

namespace viewloom::test {

inline constexpr size_t kMayFail_bytes = size_t{4} * 1024;

// From now on the allocation of at least kMayFail_bytes fails that `rank` others come before, once.
// Thread-safety: any thread.
void failAllocation(uint64_t rank);
// No allocation fails any more. True if one has failed since failAllocation().
bool stopFailing();

}  // namespace viewloom::test
