// SPDX-License-Identifier: Apache-2.0
#include "lib/tls_parts.h"

#include <ctime>
#include <utility>

#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr const char* kAuthoritiesOption = "--tls-ca";
constexpr const char* kCertificateOption = "--tls-cert";
constexpr const char* kKeyOption = "--tls-key";
constexpr const char* kFingerprintOption = "--fingerprint";

absl::StatusOr<std::optional<Fingerprint>> readFingerprint(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const absl::StatusOr<Fingerprint> parsed = Fingerprint::parse(text);
  if (parsed.ok()) return *parsed;
  return absl::InvalidArgumentError(strCat(kFingerprintOption, ": ", parsed.status().message()));
}

absl::StatusOr<std::string> readTrusted(const std::string& path) {
  if (path.empty()) return std::string();
  return readAuthorities({.option = kAuthoritiesOption, .path = path}, std::time(nullptr));
}

absl::StatusOr<std::optional<CertifiedKey>> readOwn(const TlsOptions& options) {
  if (options.certificate_file.empty() && options.key_file.empty()) return std::nullopt;
  absl::StatusOr<CertifiedKey> own = readCertifiedKey(
      {.certificate = {.option = kCertificateOption, .path = options.certificate_file},
       .key = {.option = kKeyOption, .path = options.key_file}},
      CertificatePurpose::kClient, std::time(nullptr));
  VIEWLOOM_RETURN_IF_ERROR(own.status());
  return std::optional(*std::move(own));
}

}  // namespace

absl::Status TlsParts::judge(const std::vector<Certificate>& chain, const std::string& host) const {
  if (!fingerprint) return authorities.checkServer(chain, host, std::time(nullptr));
  if (!chain.empty() && chain.front().fingerprint() == *fingerprint) return absl::OkStatus();
  return absl::UnauthenticatedError(
      strCat("the certificate of ", host,
             " is not the pinned one; if the server has a new "
             "certificate, give the fingerprint that the server itself prints"));
}

absl::StatusOr<TlsParts> readTlsParts(const TlsOptions& options) {
  const auto pinned = readFingerprint(options.fingerprint);
  VIEWLOOM_RETURN_IF_ERROR(pinned.status());
  const absl::StatusOr<std::string> pem = readTrusted(options.authorities_file);
  VIEWLOOM_RETURN_IF_ERROR(pem.status());
  absl::StatusOr<Authorities> authorities = Authorities::make(*pem);
  VIEWLOOM_RETURN_IF_ERROR(authorities.status());
  auto own = readOwn(options);
  VIEWLOOM_RETURN_IF_ERROR(own.status());
  return TlsParts{
      .fingerprint = *pinned, .authorities = *std::move(authorities), .own = *std::move(own)};
}

absl::Status checkTlsOptions(const ServerAddress& address, const TlsOptions& options) {
  const std::vector<std::pair<const char*, const std::string*>> given = {
      {kAuthoritiesOption, &options.authorities_file},
      {kCertificateOption, &options.certificate_file},
      {kKeyOption, &options.key_file},
      {kFingerprintOption, &options.fingerprint}};
  for (const auto& [option, value] : given) {
    if (value->empty() || address.has_tls) continue;
    return absl::InvalidArgumentError(strCat(option, " is given, and the address ", address.target,
                                             " has no encryption; write it as https://HOST:PORT"));
  }
  return absl::OkStatus();
}

}  // namespace viewloom
