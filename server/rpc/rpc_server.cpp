// SPDX-License-Identifier: Apache-2.0
#include "rpc/rpc_server.h"

#include <stdexcept>

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/resource_quota.h>
#include <grpcpp/security/server_credentials.h>

#include "rpc/tls_credentials.h"

namespace viewloom {
namespace {

// A chunk of 1 MiB and what surrounds it. Calls limit their other messages further.
constexpr int kReceiveBytesMax = 2 << 20;
// Calls at a time on one connection: displays and streams of one program. Libraries hold further
// calls back, and proxies open another connection for them.
constexpr int kConnectionCallsMax = 128;
// Threads for calls of reflection, each of which keeps one for as long as it is open. Our services
// have none of these. The library refuses calls beyond them.
constexpr int kReflectionThreadsMax = 16;
// Writes with more to follow are gathered up to this size. A write to a socket wakes its reader:
// 1.5 MB sent 50 KB at a time cost a server two to three times as much as in one or two writes. The
// library's default of 64 KiB was in between, and 4 MiB no better. Larger frames or windows of
// HTTP/2, which a client may ask for, gained nothing (64 clients, two cores of an AMD EPYC,
// 2026-11-22). Bands are shared, so buffers hold no copies.
constexpr int kWriteBufferBytes = 1 << 20;
// Clients may ping this often.
constexpr int kClientPingMsMin = 5000;
// A connection that opens no call for that long is closed; clients open another when they need it.
constexpr int kIdleMsMax = 60'000;
// Time to send the first bytes of HTTP/2.
constexpr int kHandshakeMsMax = 10'000;
constexpr uint32_t kProbeTicks = 4;  // 1 s

void addReflection() {
  // A setting of the process, which takes effect on servers built later.
  static const bool once = [] {
    grpc::reflection::InitProtoReflectionServerBuilderPlugin();
    return true;
  }();
  static_cast<void>(once);
}

void setLimits(grpc::ServerBuilder& builder, const RpcServerOptions& options) {
  const auto keepalive_ms = static_cast<int>(std::chrono::milliseconds(options.keepalive).count());
  grpc::ResourceQuota quota("viewloomd");
  quota.Resize(options.memory_bytes_max);
  quota.SetMaxThreads(kReflectionThreadsMax);
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
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS, kIdleMsMax);
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, kHandshakeMsMax);
  // Pictures are compressed already. A compressed message of 1 MB would take 1 GB before anything
  // could refuse it; UNIMPLEMENTED comes before it is unpacked.
  for (const auto algorithm : {GRPC_COMPRESS_DEFLATE, GRPC_COMPRESS_GZIP}) {
    builder.SetCompressionAlgorithmSupportStatus(algorithm, false);
  }
}

}  // namespace

RpcServer::RpcServer(const RpcServerOptions& options, const RpcParts& parts,
                     const ServerDescription& description)
    : drain_time_(options.drain_time),
      unread_ticks_max_(uint32_t(options.unread / kTick)),
      metrics_(parts.metrics),
      listener_({.address = options.address,
                 .connection_count_max = options.connection_count_max,
                 .acknowledge_time = std::chrono::milliseconds(options.keepalive) / 2},
                parts.metrics, parts.memory),
      credentials_(options.tls ? tlsServerCredentials(options.tls)
                               : grpc::InsecureServerCredentials()),
      ingest_({.intake = parts.intake,
               .pool = parts.pool,
               .directory = parts.directory,
               .broadcaster = parts.broadcaster,
               .clock = parts.clock,
               .metrics = parts.metrics,
               .limits = description.frame_limits,
               .memory = parts.memory,
               .prepared_bytes = parts.prepared_bytes},
              parts.access),
      display_({.directory = parts.directory,
                .broadcaster = parts.broadcaster,
                .eyes = parts.eyes,
                .clock = parts.clock,
                .metrics = parts.metrics,
                .limits = description.atlas_limits},
               parts.access, parts.memory),
      catalog_(parts.directory, parts.broadcaster, parts.access, parts.memory, description),
      health_(parts.memory,
              {v1::IngestService::service_full_name(), v1::DisplayService::service_full_name(),
               v1::CatalogService::service_full_name()}) {
  addReflection();
  grpc::ServerBuilder builder;
  setLimits(builder, options);
  constexpr auto kFromFd = grpc::ServerBuilder::experimental_type::ExternalConnectionType::FROM_FD;
  acceptor_ = builder.experimental().AddExternalConnectionAcceptor(kFromFd, credentials_);
  probe_.emplace(builder.experimental().AddExternalConnectionAcceptor(
                     kFromFd, grpc::InsecureServerCredentials()),
                 parts.clock);
  builder.RegisterService(&ingest_);
  builder.RegisterService(&display_);
  builder.RegisterService(&catalog_);
  builder.RegisterService(&health_);
  server_ = builder.BuildAndStart();
  if (server_ == nullptr) throw std::runtime_error("the gRPC library did not start its server");
  listener_.start([this](int listener_fd, int fd) {
    grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters connection;
    connection.listener_fd = listener_fd;
    connection.fd = fd;
    acceptor_->HandleNewConnection(&connection);
  });
  ticker_.emplace(kTick, [this] { tick(); });
}

RpcServer::~RpcServer() {
  drain();
  shutdown();
}

void RpcServer::drain() {
  is_draining_ = true;
  health_.drain();
  ingest_.drain();
  display_.drain();
}

absl::Status RpcServer::health() const {
  const absl::Status status = listener_.status();
  return status.ok() ? probe_->status() : status;
}

void RpcServer::tick() {
  ingest_.tick(unread_ticks_max_);
  display_.tick(unread_ticks_max_);
  catalog_.tick(unread_ticks_max_);
  health_.tick(unread_ticks_max_);
  if (tick_count_++ % kProbeTicks != 0 || is_draining_) return;
  probe_->ask();
  metrics_.grpc_connections.set(static_cast<double>(listener_.connectionCount()));
}

void RpcServer::shutdown() {
  listener_.stop();
  health_.end();
  catalog_.end();
  server_->Shutdown(std::chrono::system_clock::now() + drain_time_);
  server_->Wait();
  ticker_.reset();
}

}  // namespace viewloom
