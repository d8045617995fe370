// SPDX-License-Identifier: Apache-2.0
// Byte buffers that come back: after warm-up, frames and bands travel without touching the heap.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace viewloom {

// Bytes that several readers share; goes back to its pool with the last of them.
using SharedBytes = std::shared_ptr<const std::vector<uint8_t>>;

// Lends growable byte buffers. A returned buffer keeps its capacity and serves the next request.
// Buffers may outlive the pool. Thread-safety: all methods may be called from any thread.
class BytePool {
 public:
  using Buffer = std::shared_ptr<std::vector<uint8_t>>;

  // At most kept_count buffers wait in the pool, with kept_bytes_max of memory together; what is
  // more is freed, beginning with the buffer that has waited longest.
  explicit BytePool(size_t kept_count, size_t kept_bytes_max = std::numeric_limits<size_t>::max());
  // An empty buffer with room for capacity_bytes: the smallest of those waiting, unless even that
  // is several times too large; else a new one.
  Buffer take(size_t capacity_bytes);
  // The same, of `size_bytes`, for one who writes them all: they are what they were left as, or 0.
  Buffer takeAsLeft(size_t size_bytes);
  // The same, of the size that it was left at: for one who writes piece by piece and grows it where
  // it is too small, so that it is not filled with 0 first.
  Buffer takeUncleared(size_t capacity_bytes);

 private:
  struct Shelf;

  std::shared_ptr<Shelf> shelf_;
};

}  // namespace viewloom
