// SPDX-License-Identifier: Apache-2.0
// Channels to a server, with every limit set, and gRPC statuses as ours.
#pragma once

#include <memory>
#include <string>

#include "base/status.h"

// Declared rather than included: gRPC's headers take long to compile, and most users of this file
// only hand a channel on.
namespace grpc {
class Channel;
class Status;
}  // namespace grpc

namespace viewloom {

// Where a server listens when nothing else is said.
inline constexpr char kDefaultAddress[] = "127.0.0.1:50051";

// Largest message either way: chunks and bands hold up to 1 MiB, and the layout of 2500 views with
// their cameras takes less than 1 MiB.
inline constexpr int kMessageBytesMax = 4 << 20;

// address: "host:port" or "unix:path". Does not connect yet; plain text.
std::shared_ptr<grpc::Channel> makeChannel(const std::string& address);

// Whether what goes to this address leaves no machine: a Unix socket, or the loopback.
bool staysOnMachine(const std::string& address);

// The same status, which also tells where it comes from (isFromServer, isFromTransport) and, by
// retryDelayNs, when to ask again.
absl::Status statusFromGrpc(const grpc::Status& status);

// The server itself has answered so.
bool isFromServer(const absl::Status& status);
// A proxy has, or the connection broke.
bool isFromTransport(const absl::Status& status);

}  // namespace viewloom
