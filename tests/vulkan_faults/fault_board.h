// SPDX-License-Identifier: Apache-2.0
// Memory that the layer shares with the program which plants faults (board.py).
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace viewloom::test {

// Words in the machine's order; board.py reads and writes them by their offsets. Writing
// `left_count` arms the fault, so it comes last.
template <size_t kFunctionCount>
struct FaultBoard {
  std::atomic<uint32_t> function_count;  // by the layer: both sides know the same functions
  std::atomic<uint32_t> function;        // index of the function that fails
  std::atomic<int32_t> result;           // a VkResult; VK_SUCCESS = the call is skipped
  std::atomic<uint32_t> stays_lost;      // 1 = VK_ERROR_DEVICE_LOST holds for all later calls
  std::atomic<uint32_t> left_count;      // the fault happens as this falls to 0; 0 = none is armed
  std::atomic<uint32_t> fault_count;     // by the layer: faults so far
  std::atomic<uint64_t> fault_ns;        // by the layer: CLOCK_MONOTONIC of the last fault
  std::atomic<uint64_t> call_counts[kFunctionCount];  // by the layer
};

static_assert(offsetof(FaultBoard<1>, call_counts) == 32);

}  // namespace viewloom::test
