// SPDX-License-Identifier: Apache-2.0
// How a client and a server know each other, read from the files that options name.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/status.h"
#include "certificates/authorities.h"
#include "certificates/certified_key.h"
#include "certificates/fingerprint.h"
#include "certificates/server_address.h"
#include "lib/tls_options.h"

namespace viewloom {

struct TlsParts {
  std::optional<Fingerprint> fingerprint;  // of the server, alone, where it is given
  Authorities authorities;                 // of the server
  std::optional<CertifiedKey> own;         // of this client; empty = it shows none

  // Whether the chain, the server's own certificate first, is that of the server at `host`.
  // UNAUTHENTICATED otherwise, with the remedy.
  absl::Status judge(const std::vector<Certificate>& chain, const std::string& host) const;
};

// INVALID_ARGUMENT names the option of `viewloom` and has the remedy.
absl::StatusOr<TlsParts> readTlsParts(const TlsOptions& options);

// INVALID_ARGUMENT where an option is given and the address has no encryption.
absl::Status checkTlsOptions(const ServerAddress& address, const TlsOptions& options);

}  // namespace viewloom
