// SPDX-License-Identifier: Apache-2.0
#include "rpc/rpc_server.h"

#include <stdexcept>

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/resource_quota.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>

namespace viewloom {
namespace {

// A chunk of 1 MiB and what surrounds it; the largest display, of 1024 cameras, takes a tenth of
// it.
constexpr int kReceiveBytesMax = 2 << 20;
// Calls at a time on one connection; a proxy may carry all subscribers of a server over one.
constexpr int kConnectionCallsMax = 1024;
// Writes with more to follow are gathered up to this size. A write to a socket wakes its reader:
// 1.5 MB sent 50 KB at a time cost a server two to three times as much as in one or two writes. The
// library's default of 64 KiB was in between, and 4 MiB no better. Larger frames or windows of
// HTTP/2, which a client may ask for, gained nothing (64 clients, two cores of an AMD EPYC,
// 2026-11-22). Bands are shared, so buffers hold no copies.
constexpr int kWriteBufferBytes = 1 << 20;
// Clients may ping this often.
constexpr int kClientPingMsMin = 5000;

void addLibraryServices() {
  // Both are settings of the process and take effect on servers built later.
  static const bool once = [] {
    grpc::EnableDefaultHealthCheckService(true);
    grpc::reflection::InitProtoReflectionServerBuilderPlugin();
    return true;
  }();
  static_cast<void>(once);
}

void setLimits(grpc::ServerBuilder& builder, const RpcServerOptions& options) {
  const auto keepalive_ms = static_cast<int>(std::chrono::milliseconds(options.keepalive).count());
  grpc::ResourceQuota quota("viewloomd");
  quota.Resize(options.memory_bytes_max);
  builder.SetResourceQuota(quota);
  builder.SetMaxReceiveMessageSize(kReceiveBytesMax);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, kConnectionCallsMax);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, keepalive_ms);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, keepalive_ms / 2);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS,
                             kClientPingMsMin);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_WRITE_BUFFER_SIZE, kWriteBufferBytes);
  // Without it a second server would silently share the port and take half of the clients.
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
}

}  // namespace

RpcServer::RpcServer(const RpcServerOptions& options, const RpcParts& parts,
                     const ServerDescription& description)
    : drain_time_(options.drain_time),
      ingest_({.intake = parts.intake,
               .pool = parts.pool,
               .directory = parts.directory,
               .broadcaster = parts.broadcaster,
               .clock = parts.clock,
               .metrics = parts.metrics,
               .limits = description.frame_limits},
              parts.access),
      display_({.directory = parts.directory,
                .broadcaster = parts.broadcaster,
                .eyes = parts.eyes,
                .clock = parts.clock,
                .metrics = parts.metrics,
                .limits = description.atlas_limits},
               parts.access),
      catalog_(parts.directory, parts.broadcaster, parts.access, description) {
  addLibraryServices();
  grpc::ServerBuilder builder;
  setLimits(builder, options);
  int port = 0;
  builder.AddListeningPort(options.address, grpc::InsecureServerCredentials(), &port);
  builder.RegisterService(&ingest_);
  builder.RegisterService(&display_);
  builder.RegisterService(&catalog_);
  server_ = builder.BuildAndStart();
  if (server_ == nullptr || port == 0) {
    throw std::runtime_error(
        "cannot listen on " + options.address +
        " for gRPC: another program has the port, or the address is not of this "
        "machine; choose another with --grpc.address");
  }
  port_ = static_cast<uint16_t>(port);
  ticker_.emplace(kTick, [this] {
    ingest_.tick();
    display_.tick();
  });
  // Beside the whole server, which the library knows by itself.
  for (const char* service :
       {v1::IngestService::service_full_name(), v1::DisplayService::service_full_name(),
        v1::CatalogService::service_full_name()}) {
    server_->GetHealthCheckService()->SetServingStatus(service, true);
  }
}

RpcServer::~RpcServer() {
  drain();
  shutdown();
}

void RpcServer::drain() {
  server_->GetHealthCheckService()->SetServingStatus(false);
  ingest_.drain();
  display_.drain();
}

void RpcServer::shutdown() {
  server_->Shutdown(std::chrono::system_clock::now() + drain_time_);
  server_->Wait();
  ticker_.reset();
}

}  // namespace viewloom
