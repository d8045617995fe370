// SPDX-License-Identifier: Apache-2.0
// Memory that waits for reuse and can be given up.
#pragma once

#include <chrono>
#include <cstdint>

namespace viewloom {

// Thread-safety: all methods may be called from any thread.
class IdleMemory {
 public:
  virtual ~IdleMemory() = default;

  // Bytes that wait now and that no Reservation counts (admission/memory_budget.h).
  virtual uint64_t idleBytes() const = 0;
  // Gives up what has waited for at least this long; 0 = all of it. Returns how many bytes of
  // idleBytes() those were.
  virtual uint64_t releaseIdle(std::chrono::nanoseconds unused_for) = 0;
};

}  // namespace viewloom
