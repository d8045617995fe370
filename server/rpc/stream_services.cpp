// SPDX-License-Identifier: Apache-2.0
#include "rpc/stream_services.h"

#include "rpc/peer_host.h"

namespace viewloom {

grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* IngestService::PublishFrames(
    grpc::CallbackServerContext* context) {
  const auto call = std::make_shared<PublishCall>(parts_, peerHost(context->peer()));
  calls_.open(call);
  return call.get();
}

void IngestService::demandChanged(const std::string& stream) {
  calls_.forEach([&stream](PublishCall& call) {
    if (call.stream() == stream) call.refreshWanted();
  });
}

void IngestService::tick() {
  calls_.forEach([](PublishCall& call) { call.tick(); });
}

void IngestService::drain() {
  calls_.turnAway();
  const absl::Status status = absl::UnavailableError(kDrainMessage);
  calls_.forEach([&status](PublishCall& call) { call.end(status); });
}

grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* DisplayService::StreamAtlases(
    grpc::CallbackServerContext*) {
  const auto call = std::make_shared<WatchCall>(parts_);
  calls_.open(call);
  return call.get();
}

void DisplayService::tick() {
  calls_.forEach([](WatchCall& call) { call.tick(); });
}

void DisplayService::drain() {
  calls_.turnAway();
  calls_.forEach([](WatchCall& call) { call.endUnlessWatching(); });
}

}  // namespace viewloom
