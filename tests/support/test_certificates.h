// SPDX-License-Identifier: Apache-2.0
// Certificates for tests, good and bad ones, by authorities of their own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace viewloom {

// 2026-11-27 12:00 UTC: the day of tests that choose it.
inline constexpr int64_t kTestDay_s = 1'795'780'800;

struct TestCertificate {
  std::string pem;
  std::string key_pem;
};

struct TestCertificateWish {
  std::string name = "test";
  std::string hosts =
      "DNS:localhost,IP:127.0.0.1";  // as OpenSSL's configuration has them; "" = none
  std::string usage = "serverAuth";  // "" = any
  bool is_authority = false;
  int64_t begin_s = kTestDay_s - 86400;
  int64_t end_s = kTestDay_s + 86400;
  unsigned rsa_bits = 0;  // 0 = EC P-256
};

// Signed by `issuer`, or by itself.
TestCertificate makeTestCertificate(const TestCertificateWish& wish,
                                    const TestCertificate* issuer = nullptr);

// A key with a passphrase.
std::string protectedKey(const std::string& key_pem);

void writeText(const std::filesystem::path& path, const std::string& text);

}  // namespace viewloom
