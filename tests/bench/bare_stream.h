// SPDX-License-Identifier: Apache-2.0
// The floor of any gRPC stream: a call whose messages nobody reads into anything.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <grpcpp/channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/server.h>

#include "base/byte_pool.h"

namespace viewloom::bench {

// Takes calls of IngestService/PublishFrames, drops what comes, and answers every so many bytes
// with one message.
class BareServer {
 public:
  explicit BareServer(uint64_t answered_bytes);
  ~BareServer();

  std::string address() const;

 private:
  class Service;
  std::unique_ptr<Service> service_;
  std::unique_ptr<grpc::Server> server_;
  int port_ = 0;
};

// Sends bytes in messages of 1 MiB that share them, as fast as they go.
class BareClient {
 public:
  explicit BareClient(std::shared_ptr<grpc::Channel> channel);
  ~BareClient();

  // Returns when the server has answered.
  void send(const std::vector<SharedBytes>& planes);

 private:
  void await(void* tag);

  grpc::GenericStub stub_;
  grpc::ClientContext context_;
  grpc::CompletionQueue queue_;
  std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call_;
};

}  // namespace viewloom::bench
