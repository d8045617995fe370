// SPDX-License-Identifier: Apache-2.0
// Encryption of gRPC connections to a server.
#pragma once

#include <memory>
#include <string>

#include "base/status.h"
#include "lib/tls_options.h"

namespace grpc {
class ChannelCredentials;
}  // namespace grpc

namespace viewloom {

// Credentials for makeChannel: none for "host:port" and "unix:path", TLS for "https://host:port".
// Files are read now. INVALID_ARGUMENT names the option of `viewloom` and has the remedy.
absl::StatusOr<std::shared_ptr<grpc::ChannelCredentials>> makeCredentials(
    const std::string& address, const TlsOptions& options);

}  // namespace viewloom
