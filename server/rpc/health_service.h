// SPDX-License-Identifier: Apache-2.0
// The health of the server, by gRPC's own protocol. It needs no token. Unlike the library's
// service, it counts the calls that watch, and prices them.
#pragma once

#include <atomic>
#include <set>
#include <string>

#include "admission/memory_budget.h"
#include "grpc/health/v1/health.grpc.pb.h"
#include "rpc/health_watch.h"
#include "rpc/live_calls.h"

namespace viewloom {

// Calls that watch the health, at a time. A client needs one for each of its connections.
inline constexpr size_t kHealthWatchesMax = 1024;

// Thread-safety: all methods may be called from any thread.
class HealthService final : public grpc::health::v1::Health::WithRawCallbackMethod_Check<
                                grpc::health::v1::Health::WithRawCallbackMethod_Watch<
                                    grpc::health::v1::Health::Service>> {
 public:
  // Full names of the services that it knows, beside the whole server (""). The budget outlives it.
  HealthService(MemoryBudget& memory, std::set<std::string> services);

  // To be called every kTick: gives back the price of watches that have ended.
  void tick() {
    watches_.forEach([](HealthWatch&) {});
  }
  // NOT_SERVING from now on.
  void drain();
  // Ends all watches, and those to come, with UNAVAILABLE.
  void end();

 private:
  grpc::ServerUnaryReactor* Check(grpc::CallbackServerContext* context,
                                  const grpc::ByteBuffer* request,
                                  grpc::ByteBuffer* response) override;
  grpc::ServerWriteReactor<grpc::ByteBuffer>* Watch(grpc::CallbackServerContext* context,
                                                    const grpc::ByteBuffer* request) override;
  Serving servingOf(const std::string& service) const;

  const std::set<std::string> services_;
  std::atomic<bool> is_draining_ = false;
  LiveCalls<HealthWatch> watches_;
};

}  // namespace viewloom
