// SPDX-License-Identifier: Apache-2.0
// Makes a certificate that is signed by itself, for networks without an authority: clients pin its
// fingerprint.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/status.h"
#include "certificates/fingerprint.h"

namespace viewloom {

inline constexpr uint32_t kCertificateDaysMax = 3650;

struct CertificateWish {
  std::vector<std::string> hosts;  // names, also with a wildcard, or addresses; at least one
  uint32_t days = 825;             // from `now_s` on; 1..kCertificateDaysMax
  int64_t now_s = 0;               // since 1970
};

struct MadeCertificate {
  std::string certificate_pem;
  std::string key_pem;  // EC P-256
  Fingerprint fingerprint;
};

// INVALID_ARGUMENT when a host is neither a name nor an address, or the days are out of range.
absl::StatusOr<MadeCertificate> makeCertificate(const CertificateWish& wish);

}  // namespace viewloom
