// SPDX-License-Identifier: Apache-2.0
// Addresses of gRPC servers: HOST:PORT and unix:PATH without encryption, https://HOST:PORT with
// TLS.
#pragma once

#include <string>
#include <string_view>

namespace viewloom {

struct ServerAddress {
  std::string target;  // without the scheme and a slash at the end, as gRPC takes it
  bool has_tls = false;

  // The form that clients write: "https://HOST:PORT" with TLS.
  std::string text() const;
};

// Reads an address; whatever has no https:// before it has no TLS.
ServerAddress parseServerAddress(std::string_view text);

}  // namespace viewloom
