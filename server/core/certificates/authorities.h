// SPDX-License-Identifier: Apache-2.0
// Certificates of authorities that one end of a connection trusts, and the check of a chain.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/status.h"
#include "certificates/certificate.h"
#include "certificates/pem_file.h"

namespace viewloom {

// Reads certificates in PEM, at least one that is valid at `now_s` (seconds since 1970).
// INVALID_ARGUMENT is one sentence with the file and the remedy.
absl::StatusOr<std::string> readAuthorities(const NamedFile& file, int64_t now_s);

// Judges the certificates that servers show.
// Thread-safety: methods may be called from any thread.
class Authorities {
 public:
  // `pem`: certificates to trust, or "" for those of the system.
  static absl::StatusOr<Authorities> make(const std::string& pem);

  // Whether the chain, the server's own certificate first, leads to an authority, is valid at
  // `now_s`, and is for `host` (a name, or an address without brackets). UNAUTHENTICATED is one
  // sentence with the remedy.
  absl::Status checkServer(const std::vector<Certificate>& chain, const std::string& host,
                           int64_t now_s) const;

 private:
  explicit Authorities(OpensslPtr<X509_STORE> store) : store_(std::move(store)) {}

  OpensslPtr<X509_STORE> store_;
};

}  // namespace viewloom
