// SPDX-License-Identifier: Apache-2.0
#include "base/byte_pool.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "base/idle_memory.h"

namespace viewloom {
namespace {

// Buffers are made in steps of a quarter of a power of two, so that sizes that vary a little from
// frame to frame (JPEG, zstd) find the same buffers again.
size_t roundedUp(size_t capacity_bytes) {
  constexpr size_t kStepMin = 256;
  const size_t step = std::max(std::bit_floor(capacity_bytes) / 4, kStepMin);
  return (capacity_bytes + step - 1) / step * step;
}

// A larger buffer than this would be missing where it is needed, and all of it is in memory.
size_t capacityMax(size_t capacity_bytes) {
  constexpr size_t kLarge_bytes = size_t{1} << 20;
  return roundedUp(capacity_bytes) * (capacity_bytes < kLarge_bytes ? 4 : 2);
}

}  // namespace

struct BytePool::Shelf final : IdleMemory {
  using Clock = std::chrono::steady_clock;
  using Bytes = std::unique_ptr<std::vector<uint8_t>>;

  struct Free {
    Bytes bytes;
    Clock::time_point since;
  };

  Shelf(size_t count, size_t bytes_max) : kept_count(count), kept_bytes_max(bytes_max) {
    waiting.reserve(kept_count + 1);
  }

  const size_t kept_count;
  const size_t kept_bytes_max;
  mutable std::mutex mutex;  // guards what follows
  size_t waiting_bytes = 0;
  std::vector<Free> waiting;  // longest waiting first

  Bytes takeFitting(size_t capacity_bytes) {
    std::lock_guard lock(mutex);
    auto best = waiting.end();
    for (auto it = waiting.begin(); it != waiting.end(); ++it) {
      const size_t got = it->bytes->capacity();
      if (got < capacity_bytes || got > capacityMax(capacity_bytes)) continue;
      if (best == waiting.end() || got < best->bytes->capacity()) best = it;
    }
    if (best == waiting.end()) return nullptr;
    return remove(best);
  }

  void putBack(Bytes buffer) {
    if (buffer->capacity() > kept_bytes_max) return;
    std::lock_guard lock(mutex);
    waiting_bytes += buffer->capacity();
    waiting.push_back({std::move(buffer), Clock::now()});
    while (waiting.size() > kept_count || waiting_bytes > kept_bytes_max) remove(waiting.begin());
  }

  uint64_t idleBytes() const override {
    std::lock_guard lock(mutex);
    return waiting_bytes;
  }

  uint64_t releaseIdle(std::chrono::nanoseconds unused_for) override {
    const Clock::time_point until = Clock::now() - unused_for;
    std::lock_guard lock(mutex);
    const size_t before_bytes = waiting_bytes;
    while (!waiting.empty() && waiting.front().since <= until) remove(waiting.begin());
    return before_bytes - waiting_bytes;
  }

 private:
  Bytes remove(std::vector<Free>::iterator at) {
    Bytes removed = std::move(at->bytes);
    waiting.erase(at);
    waiting_bytes -= removed->capacity();
    return removed;
  }
};

BytePool::BytePool(size_t kept_count, size_t kept_bytes_max)
    : shelf_(std::make_shared<Shelf>(kept_count, kept_bytes_max)) {}

std::shared_ptr<IdleMemory> BytePool::idleMemory() const {
  return shelf_;
}

BytePool::Buffer BytePool::take(size_t capacity_bytes) {
  Buffer buffer = takeUncleared(capacity_bytes);
  buffer->clear();
  return buffer;
}

BytePool::Buffer BytePool::takeAsLeft(size_t size_bytes) {
  Buffer buffer = takeUncleared(size_bytes);
  buffer->resize(size_bytes);
  return buffer;
}

BytePool::Buffer BytePool::takeUncleared(size_t capacity_bytes) {
  auto buffer = shelf_->takeFitting(capacity_bytes);
  if (!buffer) {
    buffer = std::make_unique<std::vector<uint8_t>>();
    buffer->reserve(roundedUp(capacity_bytes));
  }
  return Buffer(buffer.release(), [shelf = shelf_](std::vector<uint8_t>* returned) {
    shelf->putBack(std::unique_ptr<std::vector<uint8_t>>(returned));
  });
}

}  // namespace viewloom
