// SPDX-License-Identifier: Apache-2.0
// One client's call that watches the health of the server.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include <grpcpp/support/byte_buffer.h>

#include "base/status.h"
#include "grpc/health/v1/health.pb.h"
#include "rpc/one_request_call.h"

namespace viewloom {

using Serving = grpc::health::v1::HealthCheckResponse::ServingStatus;

// Tells the state once, and once more if the server drains.
class HealthWatch final : public OneRequestCall {
 public:
  // State of the service that a request names.
  using ServingOf = std::function<absl::StatusOr<Serving>(grpc::ByteBuffer& request)>;

  HealthWatch(std::string identity, ServingOf serving_of)
      : OneRequestCall(std::move(identity)), serving_of_(std::move(serving_of)) {}

  // A service that served serves no more.
  void drain();

 private:
  absl::Status handleRequest(grpc::ByteBuffer& bytes) override;
  std::optional<grpc::ByteBuffer> takeMessage() override;
  void tell(Serving serving);  // with the lock

  const ServingOf serving_of_;
  // Under mutex_.
  std::optional<Serving> newest_;
  bool is_untold_ = false;
  bool is_draining_ = false;
};

}  // namespace viewloom
