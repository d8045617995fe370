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
  const bool is_worth = heap.noteUsed(budget.reservedBytes() + budget.idleBytes());
  if (is_worth || released_bytes >= HeapWatch::kWorthReturning_bytes) returnFreedMemory();
}

}  // namespace

bool HeapWatch::noteUsed(uint64_t used_bytes) {
  last_bytes_[call_count_++ % last_bytes_.size()] = used_bytes;
  highest_bytes_ = std::max(highest_bytes_, used_bytes);
  if (call_count_ < last_bytes_.size()) return false;
  const uint64_t lately_bytes = *std::ranges::max_element(last_bytes_);
  if (highest_bytes_ - lately_bytes < kWorthReturning_bytes) return false;
  highest_bytes_ = lately_bytes;
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
