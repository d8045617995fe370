// SPDX-License-Identifier: Apache-2.0
// The health of the server, by gRPC's own protocol. It needs no token. Unlike the library's
// service, it counts its calls, and prices them.
#pragma once

#include <atomic>
#include <cstdint>
#include <set>
#include <string>

#include "admission/memory_budget.h"
#include "grpc/health/v1/health.grpc.pb.h"
#include "rpc/health_watch.h"
#include "rpc/live_calls.h"
#include "rpc/one_request_call.h"

namespace viewloom {

// Calls that watch the health, and calls that ask once, at a time. A client needs one for each of
// its connections. They have a share of memory of their own: a client whose streams take all of
// its share is well nevertheless.
inline constexpr size_t kHealthCallsMax = 1024;

// Thread-safety: all methods may be called from any thread, tick() from one.
class HealthService final : public EarlyService<grpc::health::v1::Health::Service> {
 public:
  // Full names of the services that it knows, beside the whole server (""). The budget outlives it.
  HealthService(MemoryBudget& memory, std::set<std::string> services);

  // To be called every kTick; cuts calls like IngestService::tick.
  void tick(uint32_t unread_ticks_max);
  // NOT_SERVING from now on.
  void drain();
  // Ends all calls, and those to come, with UNAVAILABLE.
  void end();

 private:
  absl::StatusOr<Serving> servingOf(grpc::ByteBuffer& request) const;

  const std::set<std::string> services_;
  std::atomic<bool> is_draining_ = false;
  LiveCalls<QuestionCall> checks_;
  LiveCalls<HealthWatch> watches_;
};

}  // namespace viewloom
