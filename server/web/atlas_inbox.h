// SPDX-License-Identifier: Apache-2.0
// The newest atlas of a display, kept for one reader until it is ready for it.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "access/quota_ledger.h"
#include "base/clock.h"
#include "base/latest_mailbox.h"
#include "metrics/metrics.h"
#include "publish/subscriber.h"

namespace viewloom {

// Thread-safety: all methods may be called from any thread; none blocks on anything but the lock.
class AtlasInbox final : public Subscriber {
 public:
  struct Arrival {
    AtlasPtr atlas;
    int64_t arrived_ns = 0;
  };

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
    if (mailbox_.push({std::move(atlas), clock_.nowNs()})) replaced_.add();
    on_change_();
  }
  void end(const absl::Status& status) override {
    {
      std::lock_guard lock(mutex_);
      ended_ = status;
    }
    on_change_();
  }

  // Empties the slot.
  std::optional<Arrival> take() { return mailbox_.take(); }
  // Set once nothing will come any more.
  std::optional<absl::Status> ended() const {
    std::lock_guard lock(mutex_);
    return ended_;
  }
  // Atlases that a newer one replaced before they were taken.
  uint64_t replacedCount() const { return mailbox_.replacedCount(); }

 private:
  const Clock& clock_;
  const Counter replaced_;
  const std::function<void()> on_change_;
  const std::string identity_;
  const QuotaPartPtr quota_;
  LatestMailbox<Arrival> mailbox_;
  mutable std::mutex mutex_;  // of ended_
  std::optional<absl::Status> ended_;
};

}  // namespace viewloom
