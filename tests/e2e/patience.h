// SPDX-License-Identifier: Apache-2.0
// The time after which calls of a test that fails end.
#pragma once

#include <chrono>

#include <grpcpp/client_context.h>

namespace viewloom {

inline void endAfterAMinute(grpc::ClientContext& context) {
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::minutes(1));
}

}  // namespace viewloom
