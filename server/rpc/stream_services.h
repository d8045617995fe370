// SPDX-License-Identifier: Apache-2.0
// The services whose clients stay: one call per publisher and per viewer, that lives until it ends.
#pragma once

#include <cstdint>
#include <string>

#include "rpc/live_calls.h"
#include "rpc/publish_call.h"
#include "rpc/watch_call.h"
#include "viewloom/v1/display_service.grpc.pb.h"
#include "viewloom/v1/ingest_service.grpc.pb.h"

namespace viewloom {

// Opens a PublishCall per publisher. Thread-safety: all methods may be called from any thread.
class IngestService final
    : public v1::IngestService::WithRawCallbackMethod_PublishFrames<v1::IngestService::Service> {
 public:
  IngestService(const IngestParts& parts, AccessControl& access)
      : parts_(parts), access_(access), calls_(parts.memory) {}

  // The set of displays of a stream changed: its publisher hears what they want.
  void demandChanged(const std::string& stream);
  // To be called every kTick. Calls whose clients take nothing for so many ticks are cut.
  void tick(uint32_t unread_ticks_max);
  // Ends all calls, and those to come, with UNAVAILABLE.
  void drain();

 private:
  grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* PublishFrames(
      grpc::CallbackServerContext* context) override;

  const IngestParts parts_;
  AccessControl& access_;
  LiveCalls<PublishCall> calls_;
};

// Opens a WatchCall per client. Thread-safety: all methods may be called from any thread.
class DisplayService final
    : public v1::DisplayService::WithRawCallbackMethod_StreamAtlases<v1::DisplayService::Service> {
 public:
  DisplayService(const DisplayParts& parts, AccessControl& access, MemoryBudget& memory)
      : parts_(parts), access_(access), calls_(memory) {}

  // To be called every kTick; cuts calls like IngestService::tick.
  void tick(uint32_t unread_ticks_max);
  // Ends calls to come, and those that watch nothing yet, with UNAVAILABLE. The others end with
  // Broadcaster::drain, when the last atlas was offered to them.
  void drain();

 private:
  grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* StreamAtlases(
      grpc::CallbackServerContext* context) override;

  const DisplayParts parts_;
  AccessControl& access_;
  LiveCalls<WatchCall> calls_;
};

}  // namespace viewloom
