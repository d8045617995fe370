// SPDX-License-Identifier: Apache-2.0
// Credentials of a gRPC port that takes its certificate anew for each connection.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_context.h>

#include "tls/tls_material.h"

namespace viewloom {

// TLS 1.2 or 1.3. They have to outlive the server that uses them. `current` gives what new
// connections are to use; it is called from any thread for as long as the server lives, and never
// gives null. Whether clients are asked for certificates is settled by its first answer.
std::shared_ptr<grpc::ServerCredentials> tlsServerCredentials(
    std::function<TlsMaterialPtr()> current);

// Subject of the certificate that the client of a call has shown ("CN=publisher-1,O=Lab"); "" when
// it has shown none. gRPC has checked the certificate by then.
std::string clientSubject(const grpc::ServerContextBase& call);

}  // namespace viewloom
