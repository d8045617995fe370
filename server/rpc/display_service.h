// SPDX-License-Identifier: Apache-2.0
// DisplayService: opens a WatchCall per client.
#pragma once

#include "rpc/display_parts.h"
#include "rpc/live_calls.h"
#include "rpc/watch_call.h"
#include "viewloom/v1/display_service.grpc.pb.h"

namespace viewloom {

// Thread-safety: all methods may be called from any thread.
class DisplayService final
    : public v1::DisplayService::WithRawCallbackMethod_StreamAtlases<v1::DisplayService::Service> {
 public:
  explicit DisplayService(const DisplayParts& parts) : parts_(parts) {}

  // To be called every kTick.
  void tick();
  // Ends calls to come, and those that watch nothing yet, with UNAVAILABLE. The others end with
  // Broadcaster::drain, when the last atlas was offered to them.
  void drain();

 private:
  grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* StreamAtlases(
      grpc::CallbackServerContext* context) override;

  const DisplayParts parts_;
  LiveCalls<WatchCall> calls_;
};

}  // namespace viewloom
