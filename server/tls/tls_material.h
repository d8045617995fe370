// SPDX-License-Identifier: Apache-2.0
// Everything that a listening port needs for TLS, read from files and checked.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/status.h"
#include "certificates/certified_key.h"

namespace viewloom {

struct TlsFiles {
  std::string certificate;  // paths of files in PEM
  std::string key;
  std::string client_authorities;  // empty = clients are not asked for certificates
  // Whether a client without a certificate is refused. Others are always refused when their
  // certificate is not of client_authorities.
  bool is_client_required = true;
};

struct TlsMaterial {
  CertifiedKey certified_key;
  std::string client_authorities_pem;  // empty = clients are not asked for certificates
  bool is_client_required = true;
};
using TlsMaterialPtr = std::shared_ptr<const TlsMaterial>;

// INVALID_ARGUMENT is one sentence that names setting and file, and has the remedy.
absl::StatusOr<TlsMaterialPtr> readTlsMaterial(const TlsFiles& files, int64_t now_s);

}  // namespace viewloom
