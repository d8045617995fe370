// SPDX-License-Identifier: Apache-2.0
// Holds one item, the newest. An item that it replaces is returned and counted.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <utility>

namespace viewloom {

// Thread-safety: all methods may be called from any thread; none blocks on anything but the lock.
template <typename Item>
class LatestMailbox {
 public:
  // Puts an item in. Returns the item that it replaced, if nobody had taken that.
  std::optional<Item> push(Item item) {
    std::lock_guard lock(mutex_);
    std::optional<Item> replaced = std::exchange(slot_, std::move(item));
    replaced_count_ += replaced.has_value();
    return replaced;
  }

  std::optional<Item> take() {
    std::lock_guard lock(mutex_);
    return std::exchange(slot_, std::nullopt);
  }

  bool empty() const {
    std::lock_guard lock(mutex_);
    return !slot_.has_value();
  }

  uint64_t replacedCount() const {
    std::lock_guard lock(mutex_);
    return replaced_count_;
  }

 private:
  mutable std::mutex mutex_;
  std::optional<Item> slot_;
  uint64_t replaced_count_ = 0;
};

}  // namespace viewloom
