// SPDX-License-Identifier: Apache-2.0
// IngestService: opens a PublishCall per publisher.
#pragma once

#include <string>

#include "rpc/ingest_parts.h"
#include "rpc/live_calls.h"
#include "rpc/publish_call.h"
#include "viewloom/v1/ingest_service.grpc.pb.h"

namespace viewloom {

// Thread-safety: all methods may be called from any thread.
class IngestService final
    : public v1::IngestService::WithRawCallbackMethod_PublishFrames<v1::IngestService::Service> {
 public:
  explicit IngestService(const IngestParts& parts) : parts_(parts) {}

  // The set of displays of a stream changed: its publisher hears what they want.
  void demandChanged(const std::string& stream);
  // To be called every kTick.
  void tick();
  // Ends all calls, and those to come, with UNAVAILABLE.
  void drain();

 private:
  grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* PublishFrames(
      grpc::CallbackServerContext* context) override;

  const IngestParts parts_;
  LiveCalls<PublishCall> calls_;
};

}  // namespace viewloom
