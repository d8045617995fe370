// SPDX-License-Identifier: Apache-2.0
#include "lib/credentials.h"

#include <optional>
#include <utility>
#include <vector>

#include <grpcpp/security/credentials.h>
#include <grpcpp/security/tls_certificate_provider.h>
#include <grpcpp/security/tls_certificate_verifier.h>
#include <grpcpp/security/tls_credentials_options.h>

#include "base/host_port.h"
#include "base/str_cat.h"
#include "certificates/certificate.h"
#include "certificates/server_address.h"
#include "lib/tls_parts.h"

namespace viewloom {
namespace {

namespace tls = grpc::experimental;

absl::Status judge(const TlsParts& parts, const std::string& chain_pem, const std::string& host) {
  const absl::StatusOr<std::vector<Certificate>> chain = parseCertificates(chain_pem);
  VIEWLOOM_RETURN_IF_ERROR(chain.status());
  return parts.judge(*chain, host);
}

// gRPC has the server prove that it has the key of its certificate. Whose certificate it is, is
// judged here, so that a refusal can say why.
class ServerVerifier final : public tls::ExternalCertificateVerifier {
 public:
  explicit ServerVerifier(TlsParts parts) : parts_(std::move(parts)) {}

  bool Verify(tls::TlsCustomVerificationCheckRequest* request, std::function<void(grpc::Status)>,
              grpc::Status* answer) override {
    const auto textOf = [](grpc::string_ref part) { return std::string(part.data(), part.size()); };
    const std::string target = textOf(request->target_name());
    const std::optional<HostPort> parsed = parseHostPort(target);
    std::string chain_pem = textOf(request->peer_cert_full_chain());
    if (chain_pem.empty()) chain_pem = textOf(request->peer_cert());
    const absl::Status judged = judge(parts_, chain_pem, parsed ? parsed->host : target);
    if (!judged.ok()) {
      *answer = grpc::Status(grpc::StatusCode::UNAUTHENTICATED, std::string(judged.message()));
    }
    return true;  // it is judged already
  }
  void Cancel(tls::TlsCustomVerificationCheckRequest*) override {}

 private:
  const TlsParts parts_;
};

absl::Status checkAddress(const ServerAddress& address, const TlsOptions& options) {
  VIEWLOOM_RETURN_IF_ERROR(checkTlsOptions(address, options));
  const std::optional<HostPort> parsed = parseHostPort(address.target);
  if (!address.has_tls || (parsed && parsed->port)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      strCat("got the address ", address.text(), "; accepted is https://HOST:PORT"));
}

}  // namespace

absl::StatusOr<std::shared_ptr<grpc::ChannelCredentials>> makeCredentials(
    const std::string& address, const TlsOptions& options) {
  const ServerAddress parsed = parseServerAddress(address);
  VIEWLOOM_RETURN_IF_ERROR(checkAddress(parsed, options));
  if (!parsed.has_tls) return grpc::InsecureChannelCredentials();
  absl::StatusOr<TlsParts> parts = readTlsParts(options);
  VIEWLOOM_RETURN_IF_ERROR(parts.status());
  tls::TlsChannelCredentialsOptions settings;
  settings.set_verify_server_certs(false);  // by ServerVerifier instead
  settings.set_check_call_host(false);      // likewise
  if (const std::optional<CertifiedKey>& own = parts->own) {
    settings.set_certificate_provider(
        std::make_shared<tls::StaticDataCertificateProvider>(std::vector<tls::IdentityKeyCertPair>{
            {.private_key = own->key_pem, .certificate_chain = own->chain_pem}}));
    settings.watch_identity_key_cert_pairs();
  }
  settings.set_certificate_verifier(
      tls::ExternalCertificateVerifier::Create<ServerVerifier>(*std::move(parts)));
  return tls::TlsCredentials(settings);
}

}  // namespace viewloom
