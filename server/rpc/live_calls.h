// SPDX-License-Identifier: Apache-2.0
// The calls of a service that are open now.
#pragma once

#include <algorithm>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "base/status.h"
#include "rpc/bidi_call.h"

namespace viewloom {

// Open calls of one kind, whether or not they have said what they want: what they cost before that
// is bounded by it. One client gets at most three quarters of what others leave, as it does of
// memory: calls that say nothing would keep everybody out.
inline constexpr size_t kOpenCallsMax = 4096;

// Thread-safety: all methods may be called from any thread. Calls are used without the lock.
template <typename Call>
class LiveCalls {
 public:
  // Opens the call; it ends at once while draining, UNAVAILABLE, or over the limit.
  void open(const std::shared_ptr<Call>& call) {
    const absl::Status status = add(call);
    if (!status.ok()) call->end(status);
    call->open();
  }

  template <typename Visit>
  void forEach(const Visit& visit) {
    for (const OpenCall& open : snapshot()) {
      if (const std::shared_ptr<Call> call = open.call.lock()) visit(*call);
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
  };

  absl::Status add(const std::shared_ptr<Call>& call) {
    std::lock_guard lock(mutex_);
    if (draining_) return absl::UnavailableError(kDrainMessage);
    std::erase_if(calls_, [](const OpenCall& open) { return open.call.expired(); });
    const auto own_count =
        size_t(std::ranges::count(calls_, call->identity(), &OpenCall::identity));
    const size_t left_count = kOpenCallsMax - (calls_.size() - own_count);
    if (own_count >= left_count - left_count / 4)
      return absl::ResourceExhaustedError("too many open calls; close some, or try again later");
    calls_.push_back({call, call->identity()});
    return absl::OkStatus();
  }

  std::vector<OpenCall> snapshot() {
    std::lock_guard lock(mutex_);
    return calls_;
  }

  std::mutex mutex_;
  std::vector<OpenCall> calls_;
  bool draining_ = false;
};

}  // namespace viewloom
