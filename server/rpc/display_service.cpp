// SPDX-License-Identifier: Apache-2.0
#include "rpc/display_service.h"

namespace viewloom {

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
