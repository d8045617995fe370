// SPDX-License-Identifier: Apache-2.0
// Knows whether the gRPC library still answers calls.
#pragma once

#include <memory>

#include <grpcpp/server_builder.h>

#include "base/clock.h"
#include "base/status.h"

namespace viewloom {

// Calls the server again and again, over a pair of sockets of its own. An answer of any kind shows
// that the library has memory and threads for calls. The library's in-process channel would not do:
// a call after its server has closed it ends the process (1.51).
//
// Thread-safety: status() may be called from any thread; the rest from one at a time.
class RpcProbe {
 public:
  using Acceptor = grpc::experimental::ExternalConnectionAcceptor;

  // `acceptor` takes connections without encryption to the server that is watched.
  RpcProbe(std::unique_ptr<Acceptor> acceptor, const Clock& clock);
  // Cancels the call under way, and waits for its end.
  ~RpcProbe();
  RpcProbe(const RpcProbe&) = delete;
  RpcProbe& operator=(const RpcProbe&) = delete;

  // Calls the server, unless a call is under way. To be called about once a second, while the
  // server runs.
  void ask();
  // UNAVAILABLE if the server has not answered for 5 s.
  absl::Status status() const;

 private:
  struct Call;
  // Leaves the call without a channel if there are no descriptors.
  void connect();

  const std::unique_ptr<Acceptor> acceptor_;
  std::shared_ptr<Call> call_;
};

}  // namespace viewloom
