// SPDX-License-Identifier: Apache-2.0
// A refused call, as the client sees it.
#pragma once

#include <ostream>
#include <string>

#include <grpcpp/support/status.h>

namespace viewloom {

struct Refusal {
  grpc::StatusCode code = grpc::StatusCode::OK;
  std::string field;  // of the one violation in google.rpc.BadRequest; "" = no details

  bool operator==(const Refusal&) const = default;
};

// Fails the running test when the details contradict the status.
Refusal refusalOf(const grpc::Status& status);
std::ostream& operator<<(std::ostream& out, const Refusal& refusal);

}  // namespace viewloom
