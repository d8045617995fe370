// SPDX-License-Identifier: Apache-2.0
// A bounded set of reusable resources. Each is lent until its last borrower releases it.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "base/idle_memory.h"

namespace viewloom {

// Lends slots. A borrower keeps a slot at least until the device has finished with it. Borrowed
// slots may outlive the pool. Slots count themselves in the server's memory, free ones too. So idle
// memory here has no bytes of its own. Thread-safety: all methods may be called from any thread,
// and slots may return on any thread.
template <typename Slot>
class SlotPool {
 public:
  // `on_return` is called after each return, without a lock. It must not throw.
  SlotPool(size_t slot_count_max, std::function<void()> on_return)
      : shelf_(std::make_shared<Shelf>(slot_count_max, std::move(on_return))) {}

  // Changes the number of slots. Excess slots are freed when they return. Throws std::bad_alloc,
  // and changes nothing, where there is no memory to keep as many.
  void setCountMax(size_t slot_count_max) { shelf_->setCountMax(slot_count_max); }

  // Whether take() would succeed. The answer stays true if only this thread takes slots.
  bool hasRoom() const { return shelf_->hasRoom(); }

  // The free slots.
  std::shared_ptr<IdleMemory> idleMemory() const { return shelf_; }

  // Slots that are lent, and will come back.
  size_t lentCount() const { return shelf_->lentCount(); }
  // Whether there are no slots, neither free nor lent.
  bool isEmpty() const { return shelf_->isEmpty(); }

  // Takes a slot for which `fits(slot)` holds: a free one, or a new one from `make()`. Once
  // slot_count_max slots exist, a new one replaces a free one that does not fit. Returns nullptr if
  // all are lent. Exceptions of make() pass through.
  template <typename Fits, typename Make>
  std::shared_ptr<Slot> take(const Fits& fits, const Make& make) {
    std::unique_ptr<Slot> slot = shelf_->takeFree(fits);
    if (!slot) {
      if (!shelf_->reserve()) return nullptr;
      try {
        slot = make();
      } catch (...) {
        shelf_->unreserve();
        throw;
      }
    }
    return {slot.release(),
            [shelf = shelf_](Slot* returned) { shelf->putBack(std::unique_ptr<Slot>(returned)); }};
  }

 private:
  struct Shelf final : IdleMemory {
    using Clock = std::chrono::steady_clock;

    struct Free {
      std::unique_ptr<Slot> slot;
      Clock::time_point since;
    };

    Shelf(size_t count_max, std::function<void()> callback)
        : on_return(std::move(callback)), slot_count_max(count_max) {
      free_slots.reserve(count_max);
    }

    template <typename Fits>
    std::unique_ptr<Slot> takeFree(const Fits& fits) {
      std::lock_guard lock(mutex);
      const auto fitting = std::find_if(free_slots.begin(), free_slots.end(),
                                        [&](const Free& free) { return fits(*free.slot); });
      if (fitting == free_slots.end()) return nullptr;
      std::unique_ptr<Slot> slot = std::move(fitting->slot);
      free_slots.erase(fitting);
      return slot;
    }

    bool hasRoom() {
      std::lock_guard lock(mutex);
      return slot_count < slot_count_max || !free_slots.empty();
    }

    size_t lentCount() {
      std::lock_guard lock(mutex);
      return slot_count - free_slots.size();
    }

    bool isEmpty() {
      std::lock_guard lock(mutex);
      return slot_count == 0;
    }

    // Room for one more slot; frees a misfit for it if need be.
    bool reserve() {
      std::unique_ptr<Slot> misfit;  // freed after the lock
      std::lock_guard lock(mutex);
      if (slot_count < slot_count_max) {
        ++slot_count;
        return true;
      }
      if (free_slots.empty()) return false;
      misfit = std::move(free_slots.back().slot);
      free_slots.pop_back();
      return true;
    }

    void unreserve() {
      std::lock_guard lock(mutex);
      --slot_count;
    }

    void setCountMax(size_t count_max) {
      {
        std::lock_guard lock(mutex);
        free_slots.reserve(count_max);  // so that slots come back without taking memory
        slot_count_max = count_max;
      }
      while (takeExcess()) {
      }
    }

    // The next two give the slots back one by one, so that each is freed without the lock, and
    // without taking memory: there may be none.
    std::unique_ptr<Slot> takeExcess() {
      std::lock_guard lock(mutex);
      if (slot_count <= slot_count_max || free_slots.empty()) return nullptr;
      return remove(free_slots.end() - 1);
    }

    std::unique_ptr<Slot> takeUnused(Clock::time_point until) {
      std::lock_guard lock(mutex);
      const auto unused =
          std::ranges::find_if(free_slots, [&](const Free& free) { return free.since <= until; });
      return unused == free_slots.end() ? nullptr : remove(unused);
    }

    // Under the lock.
    std::unique_ptr<Slot> remove(typename std::vector<Free>::iterator free) {
      std::unique_ptr<Slot> slot = std::move(free->slot);
      free_slots.erase(free);
      --slot_count;
      return slot;
    }

    void putBack(std::unique_ptr<Slot> slot) {
      {
        std::lock_guard lock(mutex);
        if (slot_count > slot_count_max) {
          --slot_count;
        } else {
          free_slots.push_back({std::move(slot), Clock::now()});
        }
      }
      slot.reset();
      on_return();
    }

    uint64_t idleBytes() const override { return 0; }

    uint64_t releaseIdle(std::chrono::nanoseconds unused_for) override {
      const Clock::time_point until = Clock::now() - unused_for;
      while (takeUnused(until)) {
      }
      return 0;
    }

    const std::function<void()> on_return;
    std::mutex mutex;  // guards what follows
    size_t slot_count_max;
    size_t slot_count = 0;  // free and lent
    std::vector<Free> free_slots;
  };

  std::shared_ptr<Shelf> shelf_;
};

}  // namespace viewloom
