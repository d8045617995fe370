// SPDX-License-Identifier: Apache-2.0
#include "rpc/stream_services.h"

#include "admission/request_boundary.h"
#include "rpc/call_access.h"
#include "rpc/refused_call.h"

namespace viewloom {

grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* IngestService::PublishFrames(
    grpc::CallbackServerContext* context) {
  absl::StatusOr<Caller> caller =
      unlessThrown([&] { return admitLiveCall(access_, *context, kPublishFrames); });
  if (!caller.ok()) return new RefusedCall(caller.status());
  const auto call = std::make_shared<PublishCall>(parts_, *std::move(caller), clientHost(*context));
  call->setContext(*context);
  call->timeRefusals(parts_.metrics.call_refusal);
  calls_.open(call);
  return call.get();
}

void IngestService::demandChanged(const std::string& stream) {
  calls_.forEach([&stream](PublishCall& call) {
    if (call.stream() == stream) call.refreshWanted();
  });
}

void IngestService::tick(uint32_t unread_ticks_max) {
  calls_.forEach([unread_ticks_max](PublishCall& call) {
    call.tick();
    call.cutIfUnread(unread_ticks_max);
  });
}

void IngestService::drain() {
  calls_.turnAway();
  const absl::Status status = absl::UnavailableError(kDrainMessage);
  calls_.forEach([&status](PublishCall& call) { call.end(status); });
}

grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* DisplayService::StreamAtlases(
    grpc::CallbackServerContext* context) {
  absl::StatusOr<Caller> caller =
      unlessThrown([&] { return admitLiveCall(access_, *context, kStreamAtlases); });
  if (!caller.ok()) return new RefusedCall(caller.status());
  const auto call = std::make_shared<WatchCall>(parts_, *std::move(caller), clientHost(*context));
  call->setContext(*context);
  call->timeRefusals(parts_.metrics.call_refusal);
  calls_.open(call);
  return call.get();
}

void DisplayService::tick(uint32_t unread_ticks_max) {
  parts_.broadcaster.remakeStanding(parts_.clock.nowNs());
  calls_.forEach([unread_ticks_max](WatchCall& call) {
    call.tick();
    call.cutIfUnread(unread_ticks_max);
  });
}

void DisplayService::drain() {
  calls_.turnAway();
  calls_.forEach([](WatchCall& call) { call.endUnlessWatching(); });
}

}  // namespace viewloom
