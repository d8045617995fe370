// SPDX-License-Identifier: Apache-2.0
// The ledger of a server's memory: everything that clients cause is reserved here before it is
// allocated.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/idle_memory.h"
#include "base/memory_use.h"
#include "base/status.h"

namespace viewloom {

// Somebody asks for memory.
struct MemoryRequest {
  MemoryUse use = MemoryUse::kFrames;
  // Client in whose share it counts, such as an address. Empty = the server's own.
  std::string identity{};
  uint64_t bytes = 0;
};

class MemoryBudget;

// Bytes of the budget, given back by the destructor. May outlive the budget. Thread-safety: none.
class Reservation {
 public:
  Reservation() = default;
  ~Reservation() { release(); }
  Reservation(Reservation&& other) noexcept { swap(other); }
  Reservation& operator=(Reservation&& other) noexcept {
    Reservation(std::move(other)).swap(*this);
    return *this;
  }

  uint64_t bytes() const { return bytes_; }
  // Never asks for more.
  void shrinkTo(uint64_t bytes);
  void release() { shrinkTo(0); }

 private:
  friend class MemoryBudget;
  struct Ledger;

  Reservation(std::shared_ptr<Ledger> ledger, const MemoryRequest& request);
  void swap(Reservation& other) noexcept;

  std::shared_ptr<Ledger> ledger_;
  MemoryUse use_ = MemoryUse::kFrames;
  std::string identity_;
  uint64_t bytes_ = 0;
};

// Gives out reservations while there is room. An identity gets at most three quarters of what all
// others and the server leave, so there is always room for one more. What waits for reuse counts,
// and is given up before anything is refused.
// Thread-safety: all methods may be called from any thread. No lock is held while idle memory is
// asked.
class MemoryBudget {
 public:
  using OnRefused = std::function<void(MemoryUse use)>;

  // `on_refused` is called for each refusal, on the thread of the request.
  explicit MemoryBudget(
      uint64_t total_bytes, OnRefused on_refused = [](MemoryUse) {});

  // nullopt: there is no room. Counts the refusal.
  std::optional<Reservation> tryReserve(const MemoryRequest& request);
  // The same, or RESOURCE_EXHAUSTED with what was asked ("a frame of ..."), what is left, and the
  // answer of what_fits to that ("a frame of up to 640x360 px fits"; empty = nothing does). It is
  // worth another try where it would fit if the identity had nothing else.
  using WhatFits = std::function<std::string(uint64_t left_bytes)>;
  absl::StatusOr<Reservation> reserve(const MemoryRequest& request, std::string_view what,
                                      const WhatFits& what_fits);
  // For memory that is there already: granted in any case, so that others get less.
  Reservation charge(MemoryUse use, uint64_t bytes);

  // Most that the identity would get now.
  uint64_t leftFor(const std::string& identity) const;
  // Most that a client would get if nobody else had anything, and nothing were being made.
  uint64_t mostForOne() const;

  // Idle memory counts as long as somebody holds it.
  void addIdle(const std::shared_ptr<IdleMemory>& idle);
  // Gives up what was not used for so long. Returns the bytes.
  uint64_t releaseIdle(std::chrono::nanoseconds unused_for);

  uint64_t totalBytes() const;
  uint64_t reservedBytes() const;
  uint64_t reservedBytes(MemoryUse use) const;
  uint64_t idleBytes() const;
  // The most that was reserved at a time since the last call. To be called by one thread.
  uint64_t takePeakBytes();

 private:
  // Otherwise it is refused at once: what others hold idle would be given up in vain.
  bool mayEverFit(const MemoryRequest& request) const;
  std::optional<Reservation> grant(const MemoryRequest& request);

  const OnRefused on_refused_;
  const std::shared_ptr<Reservation::Ledger> ledger_;
};

// A budget without an end, for programs that serve nobody: benchmarks, offline rendering, tests.
MemoryBudget& unboundedMemory();

// "66 kB", "1.54 GB".
std::string memoryText(uint64_t bytes);

}  // namespace viewloom
