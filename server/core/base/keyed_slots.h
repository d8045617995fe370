// SPDX-License-Identifier: Apache-2.0
// Reusable resources of which everybody has one, whatever others hold.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/slot_pool.h"

namespace viewloom {

// Lends slots to borrowers that are known by a key. A borrower without a slot always gets one; one
// that holds some gets another only while fewer than shared_count are lent in all. Slots beyond
// that are freed when they are no longer needed. Borrowed slots may outlive it. Thread-safety:
// take() from one thread at a time; slots may return on any thread.
template <typename Slot>
class KeyedSlots {
 public:
  // `on_return` is called after each return, without a lock. It must not throw.
  KeyedSlots(size_t shared_count, std::function<void()> on_return)
      : shared_count_(shared_count), pool_(shared_count, std::move(on_return)) {}

  // Whether take() would succeed. The answer stays true if only this thread takes slots.
  bool hasRoom(const std::string& key) {
    std::erase_if(lent_, [](const Lent& lent) { return lent.slot.expired(); });
    const bool holds_one =
        std::ranges::any_of(lent_, [&](const Lent& lent) { return lent.key == key; });
    return !holds_one || lent_.size() < shared_count_;
  }

  // Lends a slot that is lent already to another borrower. False: as for take().
  bool passOn(const std::shared_ptr<Slot>& slot, const std::string& key) {
    const auto found =
        std::ranges::find_if(lent_, [&](const Lent& lent) { return lent.slot.lock() == slot; });
    Lent lent = std::move(*found);
    lent_.erase(found);
    const bool has_room = hasRoom(key);
    if (has_room) lent.key = key;
    lent_.push_back(std::move(lent));
    return has_room;
  }

  // See SlotPool.
  std::shared_ptr<IdleMemory> idleMemory() const { return pool_.idleMemory(); }
  size_t lentCount() const { return pool_.lentCount(); }
  bool isEmpty() const { return pool_.isEmpty(); }

  // Like SlotPool::take(). nullptr: the borrower holds a slot, and all others are lent.
  template <typename Fits, typename Make>
  std::shared_ptr<Slot> take(const std::string& key, const Fits& fits, const Make& make) {
    if (!hasRoom(key)) return nullptr;
    pool_.setCountMax(std::max(shared_count_, lent_.size() + 1));
    std::shared_ptr<Slot> slot = pool_.take(fits, make);
    if (slot) lent_.push_back({key, slot});
    return slot;
  }

 private:
  struct Lent {
    std::string key;
    std::weak_ptr<Slot> slot;
  };

  const size_t shared_count_;
  SlotPool<Slot> pool_;
  std::vector<Lent> lent_;
};

}  // namespace viewloom
