// SPDX-License-Identifier: Apache-2.0
// Errors → gRPC statuses: the same code, and the field at fault as google.rpc.BadRequest details.
#pragma once

#include <grpcpp/support/status.h>

#include "absl/status/status.h"

namespace viewloom {

grpc::Status statusToGrpc(const absl::Status& status);

}  // namespace viewloom
