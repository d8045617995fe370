// SPDX-License-Identifier: Apache-2.0
// SHA-256 fingerprint of a certificate, by which a client knows a server without an authority.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/status.h"
#include "certificates/openssl.h"

namespace viewloom {

class Fingerprint {
 public:
  static Fingerprint of(const X509& certificate);
  // Reads 64 hexadecimal digits, with or without colons between bytes, in either case; a leading
  // "SHA256:" is allowed. INVALID_ARGUMENT for other texts.
  static absl::StatusOr<Fingerprint> parse(std::string_view text);

  // "3A:F1:...", as OpenSSL and browsers write it.
  std::string text() const;

  bool operator==(const Fingerprint&) const = default;

 private:
  std::array<uint8_t, 32> bytes_{};
};

}  // namespace viewloom
