// SPDX-License-Identifier: Apache-2.0
// A certificate: for whom it is, what it is good for, and until when.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "certificates/fingerprint.h"
#include "certificates/openssl.h"

namespace viewloom {

enum class CertificatePurpose : uint8_t { kServer, kClient };

// Thread-safety: const methods may be called from any thread.
class Certificate {
 public:
  explicit Certificate(OpensslPtr<X509> certificate) : certificate_(std::move(certificate)) {}

  // "O=Lab,CN=publisher-1" (RFC 2253); "" for a certificate without a subject.
  std::string subject() const;
  // Host names and addresses that it is made for.
  std::vector<std::string> names() const;
  // Whether it is made for a host: a name, also by a wildcard, or an address without brackets.
  bool isFor(const std::string& host) const;
  bool isFor(CertificatePurpose purpose) const;
  bool isSelfSigned() const;
  // Seconds since 1970, UTC.
  int64_t beginS() const;
  int64_t endS() const;
  Fingerprint fingerprint() const { return Fingerprint::of(*certificate_); }

  X509& get() const { return *certificate_; }

 private:
  OpensslPtr<X509> certificate_;
};

// All certificates of a text in PEM, in its order; other blocks are passed over. INVALID_ARGUMENT
// when one is damaged. Empty for a text without certificates.
absl::StatusOr<std::vector<Certificate>> parseCertificates(std::string_view pem);

// "2026-11-27", UTC.
std::string dayText(int64_t time_s);

}  // namespace viewloom
