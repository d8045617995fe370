// SPDX-License-Identifier: Apache-2.0
// One subscriber of a display, and what it was told.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

#include "admission/memory_budget.h"
#include "base/payer.h"
#include "publish/subscriber.h"

namespace viewloom {

// Thread-safety: all methods may be called from any thread;
// the subscriber is called once at a time, in order of sequence, never after end() or leave().
class Member {
 public:
  // `memory`: of the viewer, as long as it is here.
  Member(uint64_t id, std::shared_ptr<Subscriber> subscriber, Reservation memory)
      : id_(id),
        subscriber_(std::move(subscriber)),
        memory_(std::move(memory)),
        payer_(subscriber_->identity()) {}

  uint64_t id() const { return id_; }
  // Pays for the display, with the other viewers.
  const Payer& payer() const { return payer_; }

  // An atlas that a joiner finds may race with one that just comes: the older is left out.
  void begin(const GrowingAtlasPtr& atlas) {
    std::lock_guard lock(call_mutex_);
    const uint64_t sequence = atlas->atlas().sequence;
    if (gone_ || sequence <= begun_sequence_ || sequence <= offered_sequence_) return;
    begun_sequence_ = sequence;
    subscriber_->begin(atlas);
  }

  // The same of whole atlases.
  void offer(const AtlasPtr& atlas) {
    std::lock_guard lock(call_mutex_);
    if (gone_ || atlas->sequence <= offered_sequence_) return;
    offered_sequence_ = atlas->sequence;
    subscriber_->offer(atlas);
  }

  void end(const absl::Status& status) {
    std::lock_guard lock(call_mutex_);
    if (gone_.exchange(true)) return;
    subscriber_->end(status);
  }

  // Takes no lock, so that a subscriber may leave from within offer().
  void leave() { gone_ = true; }

 private:
  const uint64_t id_;
  const std::shared_ptr<Subscriber> subscriber_;
  const Reservation memory_;
  const Payer payer_;
  std::mutex call_mutex_;
  std::atomic<bool> gone_ = false;
  uint64_t begun_sequence_ = 0;  // under call_mutex_, as is the next
  uint64_t offered_sequence_ = 0;
};

using MemberPtr = std::shared_ptr<Member>;

}  // namespace viewloom
