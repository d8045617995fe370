// SPDX-License-Identifier: Apache-2.0
#include "e2e/test_server.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>

#include "absl/strings/str_cat.h"

namespace viewloom {
namespace {

constexpr size_t kPooledBuffers = 16;

}  // namespace

TestServer::TestServer(BroadcasterLimits limits, uint32_t stream_count_max)
    : pool_(kPooledBuffers),
      directory_(clock_, stream_count_max),
      broadcaster_(limits),
      sink_(directory_, broadcaster_),
      intake_(sink_, clock_, pool_, {}) {
  rpc_ = std::make_unique<RpcServer>(RpcServerOptions{.address = "127.0.0.1:0"},
                                     RpcParts{.intake = intake_,
                                              .pool = pool_,
                                              .directory = directory_,
                                              .broadcaster = broadcaster_,
                                              .clock = clock_,
                                              .metrics = metrics_},
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

std::shared_ptr<grpc::Channel> TestServer::connect(int receive_window_bytes) const {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  if (receive_window_bytes != 0) {
    arguments.SetInt(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, receive_window_bytes);
    arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  }
  return grpc::CreateCustomChannel(absl::StrCat("127.0.0.1:", rpc_->port()),
                                   grpc::InsecureChannelCredentials(), arguments);
}

}  // namespace viewloom
