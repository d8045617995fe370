// SPDX-License-Identifier: Apache-2.0
// Places of a call in the broadcaster, one after the other, and what they are told.
#include <mutex>
#include <optional>
#include <utility>

#include "admission/display_price.h"
#include "base/str_cat.h"
#include "rpc/watch_call.h"
#include "rpc/watch_seat.h"

namespace viewloom {

DisplayUse WatchCall::displayUse(const EncodingSpec& encoding) const {
  const DisplaySpec& display = asked_.display();
  std::string key = strCat(stream_, " ", displayKey(display), encodingKey(encoding));
  // A tracked display is this call's alone.
  if (eyes_ != nullptr) key += strCat("of ", absl::Hex(reinterpret_cast<uintptr_t>(eyes_.get())));
  return {.key = std::move(key),
          .pixels = atlasPixels(display),
          .rate_hz = pictureRate(display, parts_.directory.rateHz(stream_))};
}

absl::Status WatchCall::takeSeat(const std::string& field) {
  const auto self = std::static_pointer_cast<WatchCall>(shared_from_this());
  fall_outs_ = {};
  std::unique_ptr<Broadcaster::Subscription> left;
  std::shared_ptr<Seat> seat;
  {
    std::lock_guard lock(mutex_);
    seat = std::make_shared<Seat>(self, ++seat_number_, field);
    left = std::move(subscription_);
    quota_ = nullptr;
    is_rung_lost_ = false;
    outbox_.restart(seat);
    advance();
  }
  leave(std::move(left));  // before the new one, so that a change never needs a second place
  eyes_ = trackOf(asked_.display(), eyes_);
  auto quota = caller_->holdDisplay(displayUse(asked_.encoding()));
  VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(quota.status(), field));
  auto subscription =
      parts_.broadcaster.subscribe(stream_, asked_.display(), asked_.encoding(), seat, eyes_);
  if (!subscription.ok()) return seat->inField(subscription.status());
  std::lock_guard lock(mutex_);
  if (ending()) return absl::OkStatus();  // the subscription goes with this scope
  subscription_ = *std::move(subscription);
  quota_ = *std::move(quota);
  parts_.metrics.subscribers[Transport::kGrpc].add(1);
  return absl::OkStatus();
}

void WatchCall::leave(std::unique_ptr<Broadcaster::Subscription> subscription) {
  if (subscription != nullptr) parts_.metrics.subscribers[Transport::kGrpc].add(-1);
}

absl::Status WatchCall::leaveChainIfLost() {
  const std::unique_lock seat_lock(seat_mutex_, std::try_to_lock);
  if (!seat_lock.owns_lock()) return absl::OkStatus();  // a message is handled; the next tick looks
  {
    std::lock_guard lock(mutex_);
    const uint64_t count = outbox_.fallOutCount();
    if (!subscription_ || ending() || !fall_outs_.areTooMany(count, parts_.clock.nowNs())) {
      return absl::OkStatus();
    }
  }
  VIEWLOOM_RETURN_IF_ERROR(asked_.predictWithinAtlas());
  return takeSeat("open.display");
}

absl::Status WatchCall::followLine() {
  const std::unique_lock seat_lock(seat_mutex_, std::try_to_lock);
  if (!seat_lock.owns_lock()) return absl::OkStatus();  // a message is handled; the next tick looks
  bool is_lost = false;
  std::optional<RungMove> move;
  std::shared_ptr<Seat> seat;
  {
    std::lock_guard lock(mutex_);
    if (!subscription_ || ending()) return absl::OkStatus();
    is_lost = is_rung_lost_;
    if (!is_lost) move = subscription_->wantedMove(parts_.clock.nowNs());
    const auto self = std::static_pointer_cast<WatchCall>(shared_from_this());
    if (move) seat = std::make_shared<Seat>(self, seat_number_ + 1, "open.display");
  }
  if (move) moveToRung(*move, std::move(seat));
  return is_lost ? takeSeat("open.display") : absl::OkStatus();
}

// The old place is left only where the new one is granted.
void WatchCall::moveToRung(const RungMove& move, std::shared_ptr<Seat> seat) {
  QuotaPartPtr replaced;
  {
    std::lock_guard lock(mutex_);
    replaced = quota_;
  }
  EncodingSpec encoding = asked_.encoding();
  encoding.rung = move.to;
  auto quota = caller_->holdDisplay(displayUse(encoding), replaced.get());
  if (!quota.ok()) return;
  auto subscription = parts_.broadcaster.moveToRung(move, seat, parts_.clock.nowNs());
  if (!subscription.ok()) return;
  fall_outs_ = {};
  std::unique_ptr<Broadcaster::Subscription> left;  // goes after the lock, as the other would
  std::lock_guard lock(mutex_);
  if (ending()) return;
  ++seat_number_;
  left = std::exchange(subscription_, *std::move(subscription));
  quota_ = *std::move(quota);
  // Its end was told to nobody if it came before this.
  is_rung_lost_ = parts_.broadcaster.display(subscription_->displayId()) == nullptr;
  outbox_.restart(std::move(seat));
  parts_.metrics.rung_moves[move.to].add();
  // Nor was an atlas that came before this.
  const AtlasPtr newest = parts_.broadcaster.newest(subscription_->displayId());
  if (newest && newest->reference_sequence == 0) keep(newest);
  advance();
}

void WatchCall::begin(uint64_t seat_number, GrowingAtlasPtr atlas) {
  const ActiveDisplayPtr display = parts_.broadcaster.display(atlas->atlas().display_id);
  if (!display) return;
  std::lock_guard lock(mutex_);
  if (seat_number != seat_number_ || ending()) return;
  outbox_.begin(std::move(atlas), display->subscriber_count);
  advance();
}

void WatchCall::noteGrowth(uint64_t seat_number) {
  std::lock_guard lock(mutex_);
  if (seat_number == seat_number_) advance();
}

void WatchCall::offer(uint64_t seat_number, AtlasPtr atlas) {
  std::lock_guard lock(mutex_);
  if (seat_number != seat_number_ || ending()) return;
  keep(std::move(atlas));
  advance();
}

void WatchCall::keep(AtlasPtr atlas) {
  if (quota_) quota_->noteAtlas(atlas->sequence, atlas->layout->size_px.area());
  outbox_.offer(std::move(atlas));
}

void WatchCall::endSeat(uint64_t seat_number, const absl::Status& status) {
  bool half_closed = false;
  {
    std::lock_guard lock(mutex_);
    if (seat_number != seat_number_) return;
    const bool is_second = subscription_ && subscription_->rung() == VideoRung::kSecond;
    is_rung_lost_ = is_second && !status.ok();
    if (is_rung_lost_) return;  // the next tick comes back to the first
    draining_ = status.ok();
    half_closed = halfClosed();
  }
  const bool drained = status.ok() && !half_closed;
  end(drained ? absl::UnavailableError(kDrainMessage) : status);
}

}  // namespace viewloom
