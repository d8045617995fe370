// SPDX-License-Identifier: Apache-2.0
// Places of a viewer in the broadcaster, one after the other.
#include "publish/broadcaster.h"
#include "web/admission.h"
#include "web/viewer.h"

namespace viewloom {

std::shared_ptr<AtlasInbox> Viewer::makeInbox(QuotaPartPtr quota) {
  const std::weak_ptr<Viewer> viewer = weak_from_this();
  const auto executor = socket_.get_executor();
  return std::make_shared<AtlasInbox>(
      context_.clock, context_.metrics.replaced[HandOver::kWeb],
      [executor, viewer] {
        net::post(executor, [viewer] {
          if (const auto self = viewer.lock()) self->wake();
        });
      },
      identity_, std::move(quota));
}

void Viewer::sit(std::shared_ptr<AtlasInbox> inbox,
                 std::unique_ptr<Broadcaster::Subscription> subscription) {
  if (inbox_) dropped_before_ += inbox_->replacedCount();
  inbox_ = std::move(inbox);
  fall_outs_ = {};
  subscription_ = std::move(subscription);
}

absl::Status Viewer::subscribe(const AskedDisplay& asked) {
  const absl::StatusOr<WatchRequest> request = makeWatchRequest(asked);
  VIEWLOOM_RETURN_IF_ERROR(request.status());
  VIEWLOOM_RETURN_IF_ERROR(checkStream(request->stream, caller_, context_.streams));
  absl::StatusOr<QuotaPartPtr> quota =
      holdDisplay(context_, caller_, *request, inbox_ ? inbox_->quota() : nullptr, this);
  VIEWLOOM_RETURN_IF_ERROR(quota.status());
  auto inbox = makeInbox(*std::move(quota));
  EyeTrackPtr track = eyes_.trackFor(request->display);
  const WatcherPlace before = subscription_ ? subscription_->place() : WatcherPlace();
  auto subscription = context_.broadcaster.subscribe(request->stream, request->display,
                                                     request->encoding, inbox, track, before);
  VIEWLOOM_RETURN_IF_ERROR(subscription.status());
  sit(std::move(inbox), *std::move(subscription));
  eyes_.watch(request->display, subscription_->displayId(), std::move(track));
  asked_ = asked;
  return absl::OkStatus();
}

void Viewer::leaveChainIfLost() {
  if (!fall_outs_.areTooMany(inbox_->fallOutCount(), context_.clock.nowNs())) return;
  AskedDisplay changed = asked_;
  changed.encoding.set_prediction(v1::PREDICTION_WITHIN_ATLAS);
  // Where there is no room for another display, it goes on as it is.
  if (!subscribe(changed).ok()) fall_outs_.forgive();
}

void Viewer::followLine() {
  if (!subscription_) return;
  const std::optional<absl::Status> ended = inbox_->ended();
  if (ended && !ended->ok() && subscription_->rung() == VideoRung::kSecond) {
    if (absl::Status status = subscribe(asked_); !status.ok()) failure_ = std::move(status);
    return;
  }
  const std::optional<RungMove> move = subscription_->wantedMove(context_.clock.nowNs());
  if (move) moveToRung(*move);
}

// The old place is left only where the new one is granted.
void Viewer::moveToRung(const RungMove& move) {
  absl::StatusOr<WatchRequest> request = makeWatchRequest(asked_);
  if (!request.ok()) return;
  request->encoding.rung = move.to;
  absl::StatusOr<QuotaPartPtr> quota =
      holdDisplay(context_, caller_, *request, inbox_->quota(), this);
  if (!quota.ok()) return;
  auto inbox = makeInbox(*std::move(quota));
  auto subscription = context_.broadcaster.moveToRung(move, inbox, context_.clock.nowNs());
  if (!subscription.ok()) return;
  sit(std::move(inbox), *std::move(subscription));
  context_.metrics.rung_moves[move.to].add();
}

}  // namespace viewloom
