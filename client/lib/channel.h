// SPDX-License-Identifier: Apache-2.0
// Makes channels to a server, with every limit set, and converts gRPC statuses.
#pragma once

#include <memory>
#include <string>

#include "base/status.h"
#include "lib/access_token.h"

// Declared instead of included: gRPC's headers are slow to compile, and most users of this file
// only pass a channel on.
namespace grpc {
class Channel;
class ChannelCredentials;
class Status;
}  // namespace grpc

namespace viewloom {

// Default address of a server.
inline constexpr char kDefaultAddress[] = "127.0.0.1:50051";

// Largest message in either direction. Chunks and bands hold up to 1 MiB. The layout of 2500 views
// with their cameras takes less than 1 MiB.
inline constexpr int kMessageBytesMax = 4 << 20;

// Makes a channel to "host:port" or "unix:path" without encryption, or to "https://host:port" with
// TLS. It does not connect yet. Each call shows the access token, unless it is "". `credentials` of
// makeCredentials say how server and client know each other; without them, the server is known by
// the authorities of the system. Throws std::invalid_argument if the token cannot be sent
// (isSendableToken).
std::shared_ptr<grpc::Channel> makeChannel(
    const std::string& address, const std::string& token = tokenOfEnvironment(),
    const std::shared_ptr<grpc::ChannelCredentials>& credentials = nullptr);

// Whether the address is on this machine: a Unix socket or a loopback address.
bool staysOnMachine(const std::string& address);

// Converts a status. It keeps the origin (isFromServer, isFromTransport) and the time of the next
// try (retryDelayNs).
absl::Status statusFromGrpc(const grpc::Status& status);

// Whether the server itself gave the status.
bool isFromServer(const absl::Status& status);
// Whether a proxy gave the status, or the connection broke.
bool isFromTransport(const absl::Status& status);

}  // namespace viewloom
