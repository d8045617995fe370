// SPDX-License-Identifier: Apache-2.0
#include "tls/tls_material.h"

#include <utility>

#include "certificates/authorities.h"

namespace viewloom {

absl::StatusOr<TlsMaterialPtr> readTlsMaterial(const TlsFiles& files, int64_t now_s) {
  if (files.certificate.empty() && files.key.empty()) {
    return absl::InvalidArgumentError(
        "tls.client_ca is given without tls.certificate: clients show certificates to encrypted "
        "ports alone; name the server's certificate and key, too");
  }
  absl::StatusOr<CertifiedKey> certified_key =
      readCertifiedKey({.certificate = {.option = "tls.certificate", .path = files.certificate},
                        .key = {.option = "tls.key", .path = files.key}},
                       CertificatePurpose::kServer, now_s);
  VIEWLOOM_RETURN_IF_ERROR(certified_key.status());
  std::string authorities;
  if (!files.client_authorities.empty()) {
    absl::StatusOr<std::string> read =
        readAuthorities({.option = "tls.client_ca", .path = files.client_authorities}, now_s);
    VIEWLOOM_RETURN_IF_ERROR(read.status());
    authorities = *std::move(read);
  }
  return std::make_shared<const TlsMaterial>(
      TlsMaterial{.certified_key = *std::move(certified_key),
                  .client_authorities_pem = std::move(authorities),
                  .is_client_required = files.is_client_required});
}

}  // namespace viewloom
