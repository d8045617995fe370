// SPDX-License-Identifier: Apache-2.0
// A bounded set of reusable resources. Each is lent until its last borrower releases it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace viewloom {

// Lends slots. A borrower keeps a slot at least until the device has finished with it. Borrowed
// slots may outlive the pool. Thread-safety: all methods may be called from any thread, and slots
// may return on any thread.
template <typename Slot>
class SlotPool {
 public:
  // `on_return` is called after each return, without a lock. It must not throw.
  SlotPool(size_t slot_count_max, std::function<void()> on_return)
      : shelf_(std::make_shared<Shelf>(slot_count_max, std::move(on_return))) {}

  // Changes the number of slots. Excess slots are freed when they return.
  void setCountMax(size_t slot_count_max) { shelf_->setCountMax(slot_count_max); }

  // Whether take() would succeed. The answer stays true if only this thread takes slots.
  bool hasRoom() const { return shelf_->hasRoom(); }

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
  struct Shelf {
    Shelf(size_t count_max, std::function<void()> callback)
        : on_return(std::move(callback)), slot_count_max(count_max) {
      free_slots.reserve(count_max);
    }

    template <typename Fits>
    std::unique_ptr<Slot> takeFree(const Fits& fits) {
      std::lock_guard lock(mutex);
      const auto fitting = std::find_if(free_slots.begin(), free_slots.end(),
                                        [&](const auto& slot) { return fits(*slot); });
      if (fitting == free_slots.end()) return nullptr;
      std::unique_ptr<Slot> slot = std::move(*fitting);
      free_slots.erase(fitting);
      return slot;
    }

    bool hasRoom() {
      std::lock_guard lock(mutex);
      return slot_count < slot_count_max || !free_slots.empty();
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
      misfit = std::move(free_slots.back());
      free_slots.pop_back();
      return true;
    }

    void unreserve() {
      std::lock_guard lock(mutex);
      --slot_count;
    }

    void setCountMax(size_t count_max) {
      std::vector<std::unique_ptr<Slot>> dropped;  // freed after the lock
      std::lock_guard lock(mutex);
      slot_count_max = count_max;
      while (slot_count > slot_count_max && !free_slots.empty()) {
        dropped.push_back(std::move(free_slots.back()));
        free_slots.pop_back();
        --slot_count;
      }
    }

    void putBack(std::unique_ptr<Slot> slot) {
      {
        std::lock_guard lock(mutex);
        if (slot_count > slot_count_max) {
          --slot_count;
        } else {
          free_slots.push_back(std::move(slot));
        }
      }
      slot.reset();
      on_return();
    }

    const std::function<void()> on_return;
    std::mutex mutex;  // guards what follows
    size_t slot_count_max;
    size_t slot_count = 0;  // free and lent
    std::vector<std::unique_ptr<Slot>> free_slots;
  };

  std::shared_ptr<Shelf> shelf_;
};

}  // namespace viewloom
