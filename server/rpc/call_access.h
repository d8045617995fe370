// SPDX-License-Identifier: Apache-2.0
// Proves who calls, by the metadata of a call.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include <grpcpp/server_context.h>

#include "access/access_control.h"
#include "rpc/liveness.h"

namespace viewloom {

// The client at the other end of a call: the subject of its certificate, or else its host. Clients
// with one certificate are one user's, wherever they run.
std::string clientHost(const grpc::CallbackServerContext& context);

// The caller of an RPC (operations.h), by its `authorization: Bearer` metadata. UNAUTHENTICATED or
// PERMISSION_DENIED otherwise.
absl::StatusOr<Caller> admitCall(AccessControl& access, const grpc::CallbackServerContext& context,
                                 std::string_view rpc);

// The same for a call that stays: it takes a connection of the caller's quota. RESOURCE_EXHAUSTED
// where there is none left.
absl::StatusOr<Caller> admitLiveCall(AccessControl& access,
                                     const grpc::CallbackServerContext& context,
                                     std::string_view rpc);

// The caller of a call that stays. Thread-safety: tick() belongs to one thread.
class LiveCaller {
 public:
  explicit LiveCaller(Caller caller) : caller_(std::move(caller)) {}

  const Caller& operator*() const { return caller_; }
  const Caller* operator->() const { return &caller_; }
  // To be called every kTick. Once a second it asks whether the identity still holds, and keeps to
  // its quota: see Caller::recheck.
  absl::Status tick();

 private:
  const Caller caller_;
  TicksSince checked_;
};

}  // namespace viewloom
