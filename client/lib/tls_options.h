// SPDX-License-Identifier: Apache-2.0
// Files and values by which a client and a server know each other.
#pragma once

#include <string>

namespace viewloom {

// Needs an address that begins with https://. Without any of these, the server is known by the
// authorities of the system.
struct TlsOptions {
  std::string authorities_file;  // certificates in PEM that the server's must come from
  std::string certificate_file;  // certificate and private key of this client, in PEM; both or none
  std::string key_file;
  // SHA-256 of the server's certificate, 64 hexadecimal digits: the server is known by it alone, by
  // no name and no authority, and until the certificate changes.
  std::string fingerprint;
};

}  // namespace viewloom
