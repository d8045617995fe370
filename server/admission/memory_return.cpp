// SPDX-License-Identifier: Apache-2.0
#include "admission/memory_return.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "admission/machine_memory.h"
#include "admission/request_boundary.h"
#include "base/heap.h"
#include "base/thread_name.h"

namespace viewloom {
namespace {

constexpr std::chrono::seconds kInterval{1};
constexpr std::chrono::seconds kUnusedFor{3};

// One look at the memory each second.
class Looks {
 public:
  Looks(MemoryBudget& budget, const std::function<uint64_t()>& on_tick)
      : budget_(budget), on_tick_(on_tick) {}

  void look() {
    // The peak: memory that was there for less than a second is still the heap's. It is taken
    // before and after what is unused may change.
    const uint64_t reserved_bytes = budget_.takePeakBytes();
    const uint64_t used_bytes = reserved_bytes - std::min(reserved_bytes, unpriced_bytes_);
    unpriced_bytes_ = on_tick_();
    const uint64_t released_bytes = budget_.releaseIdle(kUnusedFor);
    budget_.takePeakBytes();
    if (heap_.note({.used_bytes = used_bytes + budget_.idleBytes(),
                    .released_bytes = released_bytes,
                    .resident_bytes = ownResidentBytes()})) {
      returnFreedMemory();
    }
  }

 private:
  MemoryBudget& budget_;
  const std::function<uint64_t()>& on_tick_;
  HeapWatch heap_;
  uint64_t unpriced_bytes_ = 0;
};

}  // namespace

bool HeapWatch::note(const Look& look) {
  const size_t place = call_count_++ % kLooks;
  last_bytes_[place] = look.used_bytes;
  last_beyond_bytes_[place] = int64_t(look.resident_bytes) - int64_t(look.used_bytes);
  highest_bytes_ = std::max(highest_bytes_, look.used_bytes);
  released_bytes_ += look.released_bytes;
  if (++pause_count_ < kLooks) return false;
  const uint64_t lately_bytes = *std::ranges::max_element(last_bytes_);
  const bool was_released = released_bytes_ >= kWorthReturning_bytes;
  if (!was_released && (call_count_ < kLooks || !isLessUsed(lately_bytes))) return false;
  highest_bytes_ = lately_bytes;
  released_bytes_ = 0;
  left_bytes_.reset();
  pause_count_ = 0;
  return true;
}

// Every walk leaves the program, and parts of freed memory: the measure for the next one.
bool HeapWatch::isLessUsed(uint64_t lately_bytes) {
  const int64_t beyond_bytes = *std::ranges::min_element(last_beyond_bytes_);
  if (!left_bytes_) left_bytes_ = beyond_bytes;
  return highest_bytes_ - lately_bytes >= kWorthReturning_bytes ||
         beyond_bytes >= *left_bytes_ + int64_t(kWorthReturning_bytes);
}

MemoryReturn::MemoryReturn(MemoryBudget& budget, std::function<uint64_t()> on_tick)
    : thread_([&budget, on_tick = std::move(on_tick)](const std::stop_token& stop) {
        nameThread("memory");
        Looks looks(budget, on_tick);
        std::mutex mutex;
        std::condition_variable_any never;
        std::unique_lock lock(mutex);
        while (!never.wait_for(lock, stop, kInterval, [&] { return stop.stop_requested(); })) {
          try {
            looks.look();
          } catch (const std::exception& thrown) {
            noteThrown("a look at the memory", thrown);  // the next one is soon
          }
        }
      }) {}

}  // namespace viewloom
