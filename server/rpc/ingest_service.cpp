// SPDX-License-Identifier: Apache-2.0
#include "rpc/ingest_service.h"

namespace viewloom {

grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* IngestService::PublishFrames(
    grpc::CallbackServerContext*) {
  const auto call = std::make_shared<PublishCall>(parts_);
  calls_.open(call);
  return call.get();
}

void IngestService::demandChanged(const std::string& stream) {
  calls_.forEach([&stream](PublishCall& call) {
    if (call.stream() == stream) call.refreshWanted();
  });
}

void IngestService::drain() {
  calls_.turnAway();
  const absl::Status status = absl::UnavailableError(kDrainMessage);
  calls_.forEach([&status](PublishCall& call) { call.end(status); });
}

}  // namespace viewloom
