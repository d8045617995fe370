// SPDX-License-Identifier: Apache-2.0
#include "lib/credentials.h"

#include <ctime>
#include <optional>
#include <utility>
#include <vector>

#include <grpcpp/security/credentials.h>
#include <grpcpp/security/tls_certificate_provider.h>
#include <grpcpp/security/tls_certificate_verifier.h>
#include <grpcpp/security/tls_credentials_options.h>

#include "base/host_port.h"
#include "base/str_cat.h"
#include "certificates/authorities.h"
#include "certificates/certified_key.h"
#include "certificates/fingerprint.h"
#include "certificates/server_address.h"

namespace viewloom {
namespace {

namespace tls = grpc::experimental;

constexpr const char* kAuthoritiesOption = "--tls-ca";
constexpr const char* kCertificateOption = "--tls-cert";
constexpr const char* kKeyOption = "--tls-key";
constexpr const char* kFingerprintOption = "--fingerprint";

// How a server is known.
struct Trust {
  std::optional<Fingerprint> fingerprint;  // alone, where it is given
  Authorities authorities;
};

absl::Status judge(const Trust& trust, const std::string& chain_pem, const std::string& host) {
  const absl::StatusOr<std::vector<Certificate>> chain = parseCertificates(chain_pem);
  VIEWLOOM_RETURN_IF_ERROR(chain.status());
  if (!trust.fingerprint) return trust.authorities.checkServer(*chain, host, std::time(nullptr));
  if (!chain->empty() && chain->front().fingerprint() == *trust.fingerprint) {
    return absl::OkStatus();
  }
  return absl::UnauthenticatedError(
      strCat("the certificate of ", host,
             " is not the pinned one; if the server has a new "
             "certificate, give the fingerprint that the server itself prints"));
}

// gRPC has the server prove that it has the key of its certificate. Whose certificate it is, is
// judged here, so that a refusal can say why.
class ServerVerifier final : public tls::ExternalCertificateVerifier {
 public:
  explicit ServerVerifier(Trust trust) : trust_(std::move(trust)) {}

  bool Verify(tls::TlsCustomVerificationCheckRequest* request, std::function<void(grpc::Status)>,
              grpc::Status* answer) override {
    const auto textOf = [](grpc::string_ref part) { return std::string(part.data(), part.size()); };
    const std::string target = textOf(request->target_name());
    const std::optional<HostPort> parsed = parseHostPort(target);
    std::string chain_pem = textOf(request->peer_cert_full_chain());
    if (chain_pem.empty()) chain_pem = textOf(request->peer_cert());
    const absl::Status judged = judge(trust_, chain_pem, parsed ? parsed->host : target);
    if (!judged.ok()) {
      *answer = grpc::Status(grpc::StatusCode::UNAUTHENTICATED, std::string(judged.message()));
    }
    return true;  // it is judged already
  }
  void Cancel(tls::TlsCustomVerificationCheckRequest*) override {}

 private:
  const Trust trust_;
};

absl::Status checkAddress(const ServerAddress& address, const TlsOptions& options) {
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
  const std::optional<HostPort> parsed = parseHostPort(address.target);
  if (!address.has_tls || (parsed && parsed->port)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      strCat("got the address ", address.text(), "; accepted is https://HOST:PORT"));
}

absl::StatusOr<Trust> readTrust(const TlsOptions& options) {
  std::optional<Fingerprint> pinned;
  if (!options.fingerprint.empty()) {
    const absl::StatusOr<Fingerprint> parsed = Fingerprint::parse(options.fingerprint);
    if (!parsed.ok()) {
      return absl::InvalidArgumentError(
          strCat(kFingerprintOption, ": ", parsed.status().message()));
    }
    pinned = *parsed;
  }
  std::string pem;
  if (!options.authorities_file.empty()) {
    absl::StatusOr<std::string> read = readAuthorities(
        {.option = kAuthoritiesOption, .path = options.authorities_file}, std::time(nullptr));
    VIEWLOOM_RETURN_IF_ERROR(read.status());
    pem = *std::move(read);
  }
  absl::StatusOr<Authorities> authorities = Authorities::make(pem);
  VIEWLOOM_RETURN_IF_ERROR(authorities.status());
  return Trust{.fingerprint = pinned, .authorities = *std::move(authorities)};
}

// Nothing when the client shows no certificate.
absl::StatusOr<std::shared_ptr<tls::CertificateProviderInterface>> readOwn(
    const TlsOptions& options) {
  if (options.certificate_file.empty() && options.key_file.empty()) return nullptr;
  absl::StatusOr<CertifiedKey> own = readCertifiedKey(
      {.certificate = {.option = kCertificateOption, .path = options.certificate_file},
       .key = {.option = kKeyOption, .path = options.key_file}},
      CertificatePurpose::kClient, std::time(nullptr));
  VIEWLOOM_RETURN_IF_ERROR(own.status());
  return std::make_shared<tls::StaticDataCertificateProvider>(std::vector<tls::IdentityKeyCertPair>{
      {.private_key = own->key_pem, .certificate_chain = own->chain_pem}});
}

}  // namespace

absl::StatusOr<std::shared_ptr<grpc::ChannelCredentials>> makeCredentials(
    const std::string& address, const TlsOptions& options) {
  const ServerAddress parsed = parseServerAddress(address);
  VIEWLOOM_RETURN_IF_ERROR(checkAddress(parsed, options));
  if (!parsed.has_tls) return grpc::InsecureChannelCredentials();
  absl::StatusOr<Trust> trust = readTrust(options);
  VIEWLOOM_RETURN_IF_ERROR(trust.status());
  const auto own = readOwn(options);
  VIEWLOOM_RETURN_IF_ERROR(own.status());
  tls::TlsChannelCredentialsOptions settings;
  settings.set_verify_server_certs(false);  // by ServerVerifier instead
  settings.set_check_call_host(false);      // likewise
  settings.set_certificate_verifier(
      tls::ExternalCertificateVerifier::Create<ServerVerifier>(*std::move(trust)));
  if (*own != nullptr) {
    settings.set_certificate_provider(*own);
    settings.watch_identity_key_cert_pairs();
  }
  return tls::TlsCredentials(settings);
}

}  // namespace viewloom
