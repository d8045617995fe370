// SPDX-License-Identifier: Apache-2.0
// The gRPC server: the three services, health and reflection on one port.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>

#include "rpc/catalog_service.h"
#include "rpc/health_service.h"
#include "rpc/liveness.h"
#include "rpc/rpc_listener.h"
#include "rpc/rpc_probe.h"
#include "rpc/stream_services.h"
#include "tls/tls_material.h"

namespace viewloom {

// Everything outlives the server, and every frame that came through it.
struct RpcParts {
  FrameIntake& intake;
  BytePool& pool;
  StreamDirectory& directory;
  Broadcaster& broadcaster;
  EyeSink& eyes;
  const Clock& clock;
  const Metrics& metrics;
  AccessControl& access;
  MemoryBudget& memory = unboundedMemory();
  PreparedBytes prepared_bytes = [](const FrameFormat&) { return uint64_t{0}; };
};

struct RpcServerOptions {
  std::string address = "127.0.0.1:50551";          // host:port; port 0 = any free one
  uint32_t connection_count_max = 1024;             // further ones are closed at once
  uint64_t memory_bytes_max = uint64_t{256} << 20;  // of messages inside the gRPC library
  // How long a receiver may take to read what it was given before it is cancelled.
  std::chrono::milliseconds drain_time{2000};
  // How long a connection may be silent before it is pinged. A peer that does not answer within
  // half as long is gone, and so is its hold on a stream's name.
  std::chrono::seconds keepalive{10};
  // How long a client may take for one message, at most 1 MiB and what the library gathers with
  // it, before its call is cut.
  std::chrono::seconds unread{60};
  // Certificate and key of new connections, asked from any thread; none = no encryption.
  std::function<TlsMaterialPtr()> tls;
};

// Thread-safety: demandChanged and health may be called from any thread; the rest from one.
class RpcServer {
 public:
  // Listens. Throws std::runtime_error when the address cannot be had.
  RpcServer(const RpcServerOptions& options, const RpcParts& parts,
            const ServerDescription& description);
  // Drains and shuts down.
  ~RpcServer();

  uint16_t port() const { return listener_.port(); }
  // Whether a further client would get in and be answered. RESOURCE_EXHAUSTED or UNAVAILABLE
  // otherwise.
  absl::Status health() const;

  // To be told by Broadcaster::onDemandChange.
  void demandChanged(const std::string& stream) { ingest_.demandChanged(stream); }

  // First half of the end: NOT_SERVING, no new calls, publishers end with UNAVAILABLE once their
  // frames are reported. Receivers stay until Broadcaster::drain.
  void drain();
  // Second half: waits for the calls that are left, at most drain_time, then cancels them. None is
  // left when it returns.
  void shutdown();

 private:
  void tick();

  const std::chrono::milliseconds drain_time_;
  const uint32_t unread_ticks_max_;
  const Metrics& metrics_;
  RpcListener listener_;
  // gRPC asks it for the certificate of each new connection, and does not keep it.
  const std::shared_ptr<grpc::ServerCredentials> credentials_;
  IngestService ingest_;
  DisplayService display_;
  CatalogService catalog_;
  HealthService health_;
  std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> acceptor_;
  std::unique_ptr<grpc::Server> server_;  // after the services it calls
  std::optional<RpcProbe> probe_;
  std::atomic<bool> is_draining_ = false;
  uint32_t tick_count_ = 0;       // of the ticker's thread
  std::optional<Ticker> ticker_;  // after all that it uses
};

}  // namespace viewloom
