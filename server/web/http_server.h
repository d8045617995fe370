// SPDX-License-Identifier: Apache-2.0
// The viewer page, live atlases over WebSocket, stills, the catalogue as JSON and the metrics, over
// HTTP.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "access/access_control.h"
#include "base/clock.h"
#include "base/status.h"
#include "metrics/metrics.h"
#include "publish/broadcaster.h"
#include "publish/stream_directory.h"
#include "web/web_context.h"

namespace viewloom {

// Serves from its construction to its end, on a fixed number of threads however many viewers there
// are. Where all connections are taken, a new one takes the place of the oldest that awaits a
// request; if none does, it gets /healthz and /metrics alone.
// Thread-safety: all methods may be called from any thread.
class HttpServer {
 public:
  // Throws std::runtime_error, with the remedy, when the address cannot be listened on. What is
  // handed in outlives the server.
  // `shares`: those of the engines, in which videos are encoded; null = they have their own.
  // `grpc_health`: whether gRPC clients would get in, for /healthz; is called from any thread.
  HttpServer(HttpOptions options, const StreamDirectory& streams, Broadcaster& broadcaster,
             EyeSink& eyes, const Metrics& metrics, const Clock& clock, AccessControl& access,
             std::function<absl::Status()> grpc_health, MemoryBudget& memory = unboundedMemory(),
             FairShares* shares = nullptr);
  // Drains first.
  ~HttpServer();

  uint16_t port() const;
  // "http://127.0.0.1:8080/"
  std::string url() const;

  // Takes no more connections, lets requests under way be answered and viewers leave (close code
  // 1001, going away), at most as long as options.drain_timeout; then ends what is left.
  void drain();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace viewloom
