// SPDX-License-Identifier: Apache-2.0
// Encryption of the connection to a server, and how the two know each other.
#pragma once

#include <memory>
#include <string>

#include "base/status.h"

namespace grpc {
class ChannelCredentials;
}  // namespace grpc

namespace viewloom {

// Needs an address https://HOST:PORT. Without any of these, the server is known by the authorities
// of the system.
struct TlsOptions {
  std::string authorities_file;  // certificates in PEM that the server's must come from
  std::string certificate_file;  // certificate and private key of this client, in PEM; both or none
  std::string key_file;
  // SHA-256 of the server's certificate, 64 hexadecimal digits: the server is known by it alone, by
  // no name and no authority, and until the certificate changes.
  std::string fingerprint;
};

// Credentials for makeChannel: none for "host:port" and "unix:path", TLS for "https://host:port".
// Files are read now. INVALID_ARGUMENT names the option of `viewloom` and has the remedy.
absl::StatusOr<std::shared_ptr<grpc::ChannelCredentials>> makeCredentials(
    const std::string& address, const TlsOptions& options);

}  // namespace viewloom
