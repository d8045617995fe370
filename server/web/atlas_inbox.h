// SPDX-License-Identifier: Apache-2.0
// Newest atlas of a display, or those of chained video, kept for one reader until it is ready.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "access/quota_ledger.h"
#include "base/clock.h"
#include "metrics/metrics.h"
#include "publish/atlas_queue.h"
#include "publish/subscriber.h"

namespace viewloom {

// Thread-safety: all methods may be called from any thread; none blocks on anything but the lock.
class AtlasInbox final : public Subscriber {
 public:
  using Arrival = AtlasQueue::Waiting;

  // `on_change` is called, without a lock held, whenever there is something new to take or to
  // learn. `identity`: see Subscriber. `quota`: of the reader, for this display; null = none.
  AtlasInbox(const Clock& clock, Counter replaced, std::function<void()> on_change,
             std::string identity = "", QuotaPartPtr quota = nullptr)
      : clock_(clock),
        replaced_(replaced),
        on_change_(std::move(on_change)),
        identity_(std::move(identity)),
        quota_(std::move(quota)) {}

  std::string identity() const override { return identity_; }

  const QuotaPart* quota() const { return quota_.get(); }

  void offer(AtlasPtr atlas) override {
    if (quota_) quota_->noteAtlas(atlas->sequence, atlas->layout->size_px.area());
    {
      std::lock_guard lock(mutex_);
      const size_t missed_count = queue_.offer(std::move(atlas), clock_.nowNs());
      replaced_count_ += missed_count;
      if (missed_count > 0) replaced_.add(double(missed_count));
    }
    on_change_();
  }
  void end(const absl::Status& status) override {
    {
      std::lock_guard lock(mutex_);
      ended_ = status;
    }
    on_change_();
  }

  // The next; none = nothing waits.
  std::optional<Arrival> take() {
    std::lock_guard lock(mutex_);
    if (queue_.isEmpty()) return std::nullopt;
    return queue_.take();
  }
  // The reader has fallen out of chained video, and how often so far: see AtlasQueue.
  bool isStuck() const {
    std::lock_guard lock(mutex_);
    return queue_.isStuck();
  }
  uint64_t fallOutCount() const {
    std::lock_guard lock(mutex_);
    return queue_.fallOutCount();
  }
  // Set once nothing will come any more.
  std::optional<absl::Status> ended() const {
    std::lock_guard lock(mutex_);
    return ended_;
  }
  // Atlases that a newer one replaced before they were taken, or that the reader could not decode.
  uint64_t replacedCount() const {
    std::lock_guard lock(mutex_);
    return replaced_count_;
  }

 private:
  const Clock& clock_;
  const Counter replaced_;
  const std::function<void()> on_change_;
  const std::string identity_;
  const QuotaPartPtr quota_;
  mutable std::mutex mutex_;  // guards what follows
  AtlasQueue queue_;
  uint64_t replaced_count_ = 0;
  std::optional<absl::Status> ended_;
};

}  // namespace viewloom
