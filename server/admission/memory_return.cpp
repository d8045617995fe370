// SPDX-License-Identifier: Apache-2.0
#include "admission/memory_return.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "admission/request_boundary.h"
#include "base/heap.h"
#include "base/thread_name.h"

namespace viewloom {
namespace {

constexpr std::chrono::seconds kInterval{1};
constexpr std::chrono::seconds kUnusedFor{3};

void returnUnused(MemoryBudget& budget, HeapWatch& heap) {
  const uint64_t released_bytes = budget.releaseIdle(kUnusedFor);
  // The peak: memory that was there for less than a second is still the heap's.
  const uint64_t used_bytes = budget.takePeakBytes() + budget.idleBytes();
  if (heap.note({.used_bytes = used_bytes, .released_bytes = released_bytes})) returnFreedMemory();
}

}  // namespace

bool HeapWatch::note(const Look& look) {
  last_bytes_[call_count_++ % kLooks] = look.used_bytes;
  highest_bytes_ = std::max(highest_bytes_, look.used_bytes);
  released_bytes_ += look.released_bytes;
  const uint64_t lately_bytes = *std::ranges::max_element(last_bytes_);
  const bool has_fallen =
      call_count_ >= kLooks && highest_bytes_ - lately_bytes >= kWorthReturning_bytes;
  const bool was_released = released_bytes_ >= kWorthReturning_bytes;
  if (++pause_count_ < kLooks || (!has_fallen && !was_released)) return false;
  highest_bytes_ = lately_bytes;
  released_bytes_ = 0;
  pause_count_ = 0;
  return true;
}

MemoryReturn::MemoryReturn(MemoryBudget& budget, std::function<void()> on_tick)
    : thread_([&budget, on_tick = std::move(on_tick)](const std::stop_token& stop) {
        nameThread("memory");
        HeapWatch heap;
        std::mutex mutex;
        std::condition_variable_any never;
        std::unique_lock lock(mutex);
        while (!never.wait_for(lock, stop, kInterval, [&] { return stop.stop_requested(); })) {
          try {
            on_tick();
            returnUnused(budget, heap);
          } catch (const std::exception& thrown) {
            noteThrown("a look at the memory", thrown);  // the next one is soon
          }
        }
      }) {}

}  // namespace viewloom
