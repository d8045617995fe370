// SPDX-License-Identifier: Apache-2.0
// A certificate with its private key: what one end of a TLS connection shows the other.
#pragma once

#include <cstdint>
#include <string>

#include "base/status.h"
#include "certificates/certificate.h"
#include "certificates/pem_file.h"

namespace viewloom {

struct CertifiedKey {
  std::string chain_pem;  // the certificate, then those between it and its authority
  std::string key_pem;
  Certificate certificate;
};

struct CertifiedKeyFiles {
  NamedFile certificate;
  NamedFile key;  // may be the same file
};

// Reads both files and checks them: PEM, the key's form, that both belong together, validity at
// `now_s` (seconds since 1970), purpose, and what OpenSSL accepts. A server's certificate must name
// a host. INVALID_ARGUMENT is one sentence with the file and the remedy; it holds no secret.
absl::StatusOr<CertifiedKey> readCertifiedKey(const CertifiedKeyFiles& files,
                                              CertificatePurpose purpose, int64_t now_s);

}  // namespace viewloom
