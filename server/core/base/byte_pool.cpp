// SPDX-License-Identifier: Apache-2.0
#include "base/byte_pool.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace viewloom {
namespace {

// Buffers are made in steps of a quarter of a power of two, so that sizes that vary a little from
// frame to frame (JPEG, zstd) find the same buffers again.
size_t roundedUp(size_t capacity_bytes) {
  constexpr size_t kStepMin = 256;
  const size_t step = std::max(std::bit_floor(capacity_bytes) / 4, kStepMin);
  return (capacity_bytes + step - 1) / step * step;
}

// A larger buffer than this would be missing where it is needed.
constexpr size_t kWasteFactorMax = 4;

}  // namespace

struct BytePool::Shelf {
  size_t kept_count;
  size_t kept_bytes_max;
  std::mutex mutex;
  size_t waiting_bytes = 0;
  std::vector<std::unique_ptr<std::vector<uint8_t>>> waiting;  // longest waiting first

  std::unique_ptr<std::vector<uint8_t>> takeFitting(size_t capacity_bytes) {
    std::lock_guard lock(mutex);
    auto best = waiting.end();
    for (auto it = waiting.begin(); it != waiting.end(); ++it) {
      const size_t got = (*it)->capacity();
      if (got < capacity_bytes || got > roundedUp(capacity_bytes) * kWasteFactorMax) continue;
      if (best == waiting.end() || got < (*best)->capacity()) best = it;
    }
    if (best == waiting.end()) return nullptr;
    return remove(best);
  }

  void putBack(std::unique_ptr<std::vector<uint8_t>> buffer) {
    if (buffer->capacity() > kept_bytes_max) return;
    std::lock_guard lock(mutex);
    waiting_bytes += buffer->capacity();
    waiting.push_back(std::move(buffer));
    while (waiting.size() > kept_count || waiting_bytes > kept_bytes_max) remove(waiting.begin());
  }

 private:
  using Waiting = std::vector<std::unique_ptr<std::vector<uint8_t>>>;

  std::unique_ptr<std::vector<uint8_t>> remove(Waiting::iterator at) {
    auto removed = std::move(*at);
    waiting.erase(at);
    waiting_bytes -= removed->capacity();
    return removed;
  }
};

BytePool::BytePool(size_t kept_count, size_t kept_bytes_max) : shelf_(std::make_shared<Shelf>()) {
  shelf_->kept_count = kept_count;
  shelf_->kept_bytes_max = kept_bytes_max;
  shelf_->waiting.reserve(kept_count + 1);
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
