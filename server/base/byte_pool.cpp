// SPDX-License-Identifier: Apache-2.0
#include "base/byte_pool.h"

#include <algorithm>
#include <utility>

namespace viewloom {

struct BytePool::Shelf {
  size_t kept_count;
  std::mutex mutex;
  std::vector<std::unique_ptr<std::vector<uint8_t>>> waiting;

  std::unique_ptr<std::vector<uint8_t>> takeFitting(size_t capacity_bytes) {
    std::lock_guard lock(mutex);
    auto fits_better = [&](const auto& a, const auto& b) {
      // Buffers that are large enough first, then the smallest of them; else the largest.
      const bool a_fits = a->capacity() >= capacity_bytes;
      const bool b_fits = b->capacity() >= capacity_bytes;
      if (a_fits != b_fits) return a_fits;
      return a_fits ? a->capacity() < b->capacity() : a->capacity() > b->capacity();
    };
    auto best = std::min_element(waiting.begin(), waiting.end(), fits_better);
    if (best == waiting.end()) return nullptr;
    auto taken = std::move(*best);
    waiting.erase(best);
    return taken;
  }

  void putBack(std::unique_ptr<std::vector<uint8_t>> buffer) {
    buffer->clear();
    std::lock_guard lock(mutex);
    if (waiting.size() < kept_count) waiting.push_back(std::move(buffer));
  }
};

BytePool::BytePool(size_t kept_count) : shelf_(std::make_shared<Shelf>()) {
  shelf_->kept_count = kept_count;
  shelf_->waiting.reserve(kept_count);
}

BytePool::Buffer BytePool::take(size_t capacity_bytes) {
  auto buffer = shelf_->takeFitting(capacity_bytes);
  if (!buffer) buffer = std::make_unique<std::vector<uint8_t>>();
  buffer->reserve(capacity_bytes);
  return Buffer(buffer.release(), [shelf = shelf_](std::vector<uint8_t>* returned) {
    shelf->putBack(std::unique_ptr<std::vector<uint8_t>>(returned));
  });
}

}  // namespace viewloom
