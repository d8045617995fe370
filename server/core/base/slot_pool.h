// SPDX-License-Identifier: Apache-2.0
// A bounded set of reusable resources, lent until the last borrower lets go.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace viewloom {

// A borrower keeps a slot at least until the device is done with it. Borrowed slots may outlive the
// pool. Thread-safety: all methods may be called from any thread; slots come back on any thread.
template <typename Slot>
class SlotPool {
 public:
  // `on_return` is called, without a lock held, after each return; it must not throw.
  SlotPool(size_t slot_count_max, std::function<void()> on_return)
      : shelf_(std::make_shared<Shelf>(slot_count_max, std::move(on_return))) {}

  // From now on so many. Those too many go as they come back.
  void setCountMax(size_t slot_count_max) { shelf_->setCountMax(slot_count_max); }

  // Whether take() would find one. Of those that take and ask from one thread: it stays so.
  bool hasRoom() const { return shelf_->hasRoom(); }

  // A slot for which `fits(slot)`: a free one, else one that `make()` allocates, in the place of a
  // free misfit once slot_count_max slots exist. nullptr = all are lent. What make() throws passes.
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
