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

std::shared_ptr<WatchCall::Seat> WatchCall::nextSeat(const std::string& field) {
  const auto self = std::static_pointer_cast<WatchCall>(shared_from_this());
  return std::make_shared<Seat>(self, seat_number_ + 1, field);
}

absl::Status WatchCall::takeSeat(const std::string& field) {
  fall_outs_ = {};
  std::unique_ptr<Broadcaster::Subscription> left;
  std::shared_ptr<Seat> seat;
  {
    std::lock_guard lock(mutex_);
    seat = nextSeat(field);
    ++seat_number_;
    left = std::move(subscription_);
    quota_ = nullptr;
    is_place_lost_ = false;
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

void WatchCall::leaveChainIfLost() {
  const std::unique_lock seat_lock(seat_mutex_, std::try_to_lock);
  if (!seat_lock.owns_lock()) return;  // a message is handled; the next tick looks
  {
    std::lock_guard lock(mutex_);
    const uint64_t count = outbox_.fallOutCount();
    if (!subscription_ || ending() || !fall_outs_.areTooMany(count, parts_.clock.nowNs())) return;
  }
  AskedPicture alone = asked_;
  absl::Status status = alone.predictWithinAtlas();
  if (status.ok()) status = moveTo(alone);
  // Where there is no room for another display, it goes on as it is.
  if (!status.ok()) fall_outs_.forgive();
}

absl::Status WatchCall::followLine() {
  const std::unique_lock seat_lock(seat_mutex_, std::try_to_lock);
  if (!seat_lock.owns_lock()) return absl::OkStatus();  // a message is handled; the next tick looks
  bool is_lost = false;
  std::optional<RungMove> move;
  {
    std::lock_guard lock(mutex_);
    if (!subscription_ || ending()) return absl::OkStatus();
    is_lost = is_place_lost_;
    if (!is_lost) move = subscription_->wantedMove(parts_.clock.nowNs());
  }
  if (move) moveToRung(*move);
  return is_lost ? takeSeat("open.display") : absl::OkStatus();
}

// A place that the call has left meanwhile, since it ends, is no place: then nothing is replaced.
WatchCall::Departure WatchCall::depart() {
  std::lock_guard lock(mutex_);
  return {.from = subscription_ ? subscription_->place() : WatcherPlace(),
          .quota = quota_,
          .seat = nextSeat("open.display")};
}

absl::Status WatchCall::moveTo(const AskedPicture& asked) {
  Departure departure = depart();
  auto quota = caller_->holdDisplay(displayUse(asked.encoding()), departure.quota.get());
  VIEWLOOM_RETURN_IF_ERROR(quota.status());
  auto subscription = parts_.broadcaster.subscribe(stream_, asked.display(), asked.encoding(),
                                                   departure.seat, eyes_, departure.from);
  VIEWLOOM_RETURN_IF_ERROR(subscription.status());
  arrive(std::move(departure.seat), *std::move(subscription), *std::move(quota));
  asked_ = asked;
  return absl::OkStatus();
}

void WatchCall::moveToRung(const RungMove& move) {
  Departure departure = depart();
  EncodingSpec encoding = asked_.encoding();
  encoding.rung = move.to;
  auto quota = caller_->holdDisplay(displayUse(encoding), departure.quota.get());
  if (!quota.ok()) return;
  auto subscription = parts_.broadcaster.moveToRung(move, departure.seat, parts_.clock.nowNs());
  if (!subscription.ok()) return;
  if (arrive(std::move(departure.seat), *std::move(subscription), *std::move(quota))) {
    parts_.metrics.rung_moves[move.to].add();
  }
}

bool WatchCall::arrive(std::shared_ptr<Seat> seat,
                       std::unique_ptr<Broadcaster::Subscription> subscription,
                       QuotaPartPtr quota) {
  fall_outs_ = {};
  std::unique_ptr<Broadcaster::Subscription> left;  // goes after the lock, as the other would
  std::lock_guard lock(mutex_);
  if (ending()) return false;
  ++seat_number_;
  left = std::exchange(subscription_, std::move(subscription));
  quota_ = std::move(quota);
  // Its end was told to nobody if it came before this.
  is_place_lost_ = parts_.broadcaster.display(subscription_->displayId()) == nullptr;
  outbox_.restart(std::move(seat));
  // Nor was an atlas that came before this.
  const AtlasPtr newest = parts_.broadcaster.newest(subscription_->displayId());
  if (newest && newest->reference_sequence == 0) keep(newest);
  advance();
  return true;
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
    is_place_lost_ = is_second && !status.ok();
    if (is_place_lost_) return;  // the next tick comes back to the first
    draining_ = status.ok();
    half_closed = halfClosed();
  }
  const bool drained = status.ok() && !half_closed;
  end(drained ? absl::UnavailableError(kDrainMessage) : status);
}

}  // namespace viewloom
