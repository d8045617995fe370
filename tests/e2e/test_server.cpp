// SPDX-License-Identifier: Apache-2.0
#include "e2e/test_server.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>

#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr size_t kPooledBuffers = 16;

}  // namespace

TestServer::TestServer(BroadcasterLimits limits, uint32_t stream_count_max,
                       const std::string& address)
    : pool_(kPooledBuffers),
      directory_(clock_, stream_count_max),
      broadcaster_(limits),
      sink_(directory_, broadcaster_),
      intake_(sink_, clock_, pool_, {}) {
  rpc_ = std::make_unique<RpcServer>(RpcServerOptions{.address = address},
                                     RpcParts{.intake = intake_,
                                              .pool = pool_,
                                              .directory = directory_,
                                              .broadcaster = broadcaster_,
                                              .eyes = sink_,
                                              .clock = clock_,
                                              .metrics = metrics_,
                                              .access = access_},
                                     ServerDescription{.version = "1.2.3",
                                                       .device = "none",
                                                       .stream_count_max = stream_count_max,
                                                       .broadcaster_limits = limits});
  broadcaster_.onDemandChange([this](const std::string& stream) {
    sink_.demandChanged(stream);
    rpc_->demandChanged(stream);
  });
}

TestServer::~TestServer() {
  rpc_->drain();
  intake_.close();
  broadcaster_.drain();
  rpc_->shutdown();
}

std::shared_ptr<grpc::Channel> TestServer::connect() const {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  return grpc::CreateCustomChannel(address(), grpc::InsecureChannelCredentials(), arguments);
}

std::string TestServer::address() const {
  return strCat("127.0.0.1:", rpc_->port());
}

}  // namespace viewloom
