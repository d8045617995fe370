// SPDX-License-Identifier: Apache-2.0
// The gRPC server as viewloomd wires it, with an AnsweringSink in place of the loops.
#pragma once

#include <memory>
#include <string>

#include <grpcpp/channel.h>

#include "e2e/answering_sink.h"
#include "rpc/rpc_server.h"

namespace viewloom {

// Members in data-flow order; they go in the reverse of it.
class TestServer {
 public:
  // On any free port of the loopback, unless an address is given.
  explicit TestServer(BroadcasterLimits limits = {}, uint32_t stream_count_max = 8,
                      const std::string& address = "127.0.0.1:0");
  ~TestServer();

  // Every channel is a connection of its own.
  std::shared_ptr<grpc::Channel> connect() const;

  const StreamDirectory& directory() const { return directory_; }
  AnsweringSink& sink() { return sink_; }
  Broadcaster& broadcaster() { return broadcaster_; }
  RpcServer& rpc() { return *rpc_; }
  std::string address() const;
  const Metrics& metrics() const { return metrics_; }

 private:
  SteadyClock clock_;
  Metrics metrics_;
  AccessControl access_{clock_};
  BytePool pool_;
  StreamDirectory directory_;
  Broadcaster broadcaster_;
  AnsweringSink sink_;
  FrameIntake intake_;
  std::unique_ptr<RpcServer> rpc_;
};

}  // namespace viewloom
