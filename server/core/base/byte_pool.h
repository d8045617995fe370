// SPDX-License-Identifier: Apache-2.0
// A pool of byte buffers. After warm-up, frames and bands need no new memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace viewloom {

class IdleMemory;

// Bytes that several readers share. They return to their pool with the last reader.
using SharedBytes = std::shared_ptr<const std::vector<uint8_t>>;

// Lends growable byte buffers. A returned buffer keeps its capacity and serves the next request.
// Buffers may outlive the pool. Thread-safety: all methods may be called from any thread.
class BytePool {
 public:
  using Buffer = std::shared_ptr<std::vector<uint8_t>>;

  // The pool keeps at most kept_count free buffers, with kept_bytes_max of memory together. It
  // frees the oldest ones first.
  explicit BytePool(size_t kept_count, size_t kept_bytes_max = std::numeric_limits<size_t>::max());
  // Takes an empty buffer with room for capacity_bytes: the smallest free one that fits, or a new
  // one if that is several times too large.
  Buffer take(size_t capacity_bytes);
  // Takes a buffer of `size_bytes` with old content or 0, for callers that write all of it.
  Buffer takeAsLeft(size_t size_bytes);
  // Takes a buffer with its old size and content. For callers that write piece by piece and grow
  // it, so that it is not filled with 0 first.
  Buffer takeUncleared(size_t capacity_bytes);

  // The free buffers.
  std::shared_ptr<IdleMemory> idleMemory() const;

 private:
  struct Shelf;

  std::shared_ptr<Shelf> shelf_;
};

}  // namespace viewloom
