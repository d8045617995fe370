// SPDX-License-Identifier: Apache-2.0
// A bidirectional call on bytes: for clients that know no better, and services without a stub.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <grpcpp/channel.h>
#include <grpcpp/support/status.h>

namespace viewloom {

struct RawReply {
  std::vector<std::string> messages;
  grpc::Status status;
};

// Sends one message, closes its side and reads until the call ends, a minute at most.
RawReply converse(const std::shared_ptr<grpc::Channel>& channel, const std::string& method,
                  const std::string& message);

}  // namespace viewloom
