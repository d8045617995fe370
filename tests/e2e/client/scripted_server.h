// SPDX-License-Identifier: Apache-2.0
// A gRPC server whose calls do what the test says.
#pragma once

#include <grpcpp/server.h>
#include <grpcpp/support/sync_stream.h>

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "viewloom/v1/display_service.grpc.pb.h"
#include "viewloom/v1/ingest_service.grpc.pb.h"

namespace viewloom {

using PublishStream = grpc::ServerReaderWriter<v1::PublishFramesResponse, v1::PublishFramesRequest>;
using WatchStream = grpc::ServerReaderWriter<v1::StreamAtlasesResponse, v1::StreamAtlasesRequest>;

// Listens on a socket of its own, so that it can come back at the same address.
class ScriptedServer final : public v1::IngestService::Service, public v1::DisplayService::Service {
 public:
  // Gets the stream and the number of the call, from 1; runs on a thread of gRPC's.
  template <typename Stream>
  using Script = std::function<grpc::Status(Stream&, int call)>;

  ScriptedServer(Script<PublishStream> publish, Script<WatchStream> watch);
  ~ScriptedServer() override;

  const std::string& address() const { return address_; }
  void start();
  // Breaks off what is running.
  void stop();

 private:
  grpc::Status PublishFrames(grpc::ServerContext* context, PublishStream* stream) override;
  grpc::Status StreamAtlases(grpc::ServerContext* context, WatchStream* stream) override;

  const Script<PublishStream> publish_;
  const Script<WatchStream> watch_;
  std::string folder_;
  std::string address_;
  std::atomic<int> publish_calls_{0};
  std::atomic<int> watch_calls_{0};
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace viewloom
