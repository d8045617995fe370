// SPDX-License-Identifier: Apache-2.0
// The calls of a service that are open now.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "base/status.h"
#include "rpc/bidi_call.h"

namespace viewloom {

// Thread-safety: all methods may be called from any thread. Calls are used without the lock.
template <typename Call>
class LiveCalls {
 public:
  // Opens the call; while draining it ends at once, UNAVAILABLE.
  void open(const std::shared_ptr<Call>& call) {
    bool draining = false;
    {
      std::lock_guard lock(mutex_);
      draining = draining_;
      std::erase_if(calls_, [](const std::weak_ptr<Call>& gone) { return gone.expired(); });
      calls_.push_back(call);
    }
    call->open();
    if (draining) call->end(absl::UnavailableError(kDrainMessage));
  }

  template <typename Visit>
  void forEach(const Visit& visit) {
    for (const std::weak_ptr<Call>& weak : snapshot()) {
      if (const std::shared_ptr<Call> call = weak.lock()) visit(*call);
    }
  }

  // From now on new calls are turned away. The open ones are the caller's to end.
  void turnAway() {
    std::lock_guard lock(mutex_);
    draining_ = true;
  }

 private:
  std::vector<std::weak_ptr<Call>> snapshot() {
    std::lock_guard lock(mutex_);
    return calls_;
  }

  std::mutex mutex_;
  std::vector<std::weak_ptr<Call>> calls_;
  bool draining_ = false;
};

}  // namespace viewloom
