// SPDX-License-Identifier: Apache-2.0
// The memory of a service: its budget by the settings, what it takes itself, and what it gives
// back.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "admission/frame_price.h"
#include "admission/memory_budget.h"
#include "admission/memory_return.h"
#include "admission/unpriced_memory.h"
#include "config/config.h"
#include "metrics/metrics.h"
#include "publish/stream_directory.h"

namespace viewloom {

// Three quarters of what the machine or its cgroup has, unless the settings say otherwise.
uint64_t memoryBudgetBytes(const MemoryConfig& config);

// Most memory of the gRPC library for messages, bytes.
uint64_t messageBytesMax(uint64_t budget_bytes);

// Streams that nobody publishes or watches, as idle memory. After five seconds they are forgotten,
// the oldest first, until all frames take no more than a 32nd of the budget; at once when memory is
// short. Thread-safety: all methods may be called from any thread.
class IdleStreams final : public IdleMemory {
 public:
  // Both outlive it.
  IdleStreams(MemoryBudget& budget, StreamDirectory& directory)
      : budget_(budget), directory_(directory) {}

  // Their reservations count.
  uint64_t idleBytes() const override { return 0; }
  uint64_t releaseIdle(std::chrono::nanoseconds unused_for) override;

 private:
  MemoryBudget& budget_;
  StreamDirectory& directory_;
};

// Memory of the program itself, and the thread that gives unused memory back. Thread-safety: the
// constructor and the destructor only.
class ServiceMemory {
 public:
  // Counts what there is by now; from now on, unused memory is given back. Everything outlives it.
  // Throws std::runtime_error, with the smallest budget, where not even one frame and one display
  // have room.
  ServiceMemory(MemoryBudget& budget, StreamDirectory& directory, const Metrics& metrics,
                const PreparedBytes& prepared_bytes, bool compiles_on_cpu);

 private:
  const Reservation program_;
  const Reservation kernels_;
  const Reservation messages_;
  UnpricedMemory unpriced_;  // used by the thread of unused_ alone
  const std::shared_ptr<IdleStreams> idle_streams_;
  std::optional<MemoryReturn> unused_;  // last: its thread uses what is above
};

}  // namespace viewloom
