// SPDX-License-Identifier: Apache-2.0
// The calls of a service that are open now.
#pragma once

#include <algorithm>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "admission/display_price.h"
#include "base/status.h"
#include "rpc/bidi_call.h"

namespace viewloom {

// Calls that publish or watch a stream, of each kind.
inline constexpr size_t kOpenCallsMax = 4096;

// Bounds the open calls of one kind, whether or not they have said what they want: calls that say
// nothing would keep everybody out. One client gets at most three quarters of what others leave.
// Each call takes kOpenCallBytes of the memory budget, in its client's share.
// Thread-safety: all methods may be called from any thread. Calls are used without the lock.
template <typename Call>
class LiveCalls {
 public:
  // The budget outlives it.
  explicit LiveCalls(MemoryBudget& memory, size_t count_max = kOpenCallsMax)
      : memory_(memory), count_max_(count_max) {}

  // Opens the call. It ends at once while draining, UNAVAILABLE, and over a limit,
  // RESOURCE_EXHAUSTED.
  void open(const std::shared_ptr<Call>& call) {
    const absl::Status status = add(call);
    if (!status.ok()) call->end(status);
    call->open();
  }

  // Also gives back the places and the memory of calls that are no more.
  template <typename Visit>
  void forEach(const Visit& visit) {
    for (const std::weak_ptr<Call>& open : snapshot()) {
      if (const std::shared_ptr<Call> call = open.lock()) visit(*call);
    }
  }

  // From now on new calls are turned away. The open ones are the caller's to end.
  void turnAway() {
    std::lock_guard lock(mutex_);
    draining_ = true;
  }

 private:
  struct OpenCall {
    std::weak_ptr<Call> call;
    std::string identity;
    Reservation memory;
  };

  absl::Status add(const std::shared_ptr<Call>& call) {
    // Before the lock: idle memory is given up for it.
    absl::StatusOr<Reservation> memory = memory_.reserve(
        {.use = MemoryUse::kConnections, .identity = call->identity(), .bytes = kOpenCallBytes},
        "an open call", [](uint64_t) { return ""; });
    std::lock_guard lock(mutex_);
    if (draining_) return absl::UnavailableError(kDrainMessage);
    VIEWLOOM_RETURN_IF_ERROR(memory.status());
    forgetEnded();
    const auto own_count =
        size_t(std::ranges::count(calls_, call->identity(), &OpenCall::identity));
    const size_t left_count = count_max_ - (calls_.size() - own_count);
    if (own_count >= left_count - left_count / 4)
      return absl::ResourceExhaustedError("too many open calls; close some, or try again later");
    calls_.push_back({call, call->identity(), *std::move(memory)});
    return absl::OkStatus();
  }

  std::vector<std::weak_ptr<Call>> snapshot() {
    std::lock_guard lock(mutex_);
    forgetEnded();
    std::vector<std::weak_ptr<Call>> calls;
    calls.reserve(calls_.size());
    for (const OpenCall& open : calls_) calls.push_back(open.call);
    return calls;
  }

  // With the lock.
  void forgetEnded() {
    std::erase_if(calls_, [](const OpenCall& open) { return open.call.expired(); });
  }

  MemoryBudget& memory_;
  const size_t count_max_;
  std::mutex mutex_;
  std::vector<OpenCall> calls_;
  bool draining_ = false;
};

}  // namespace viewloom
