// SPDX-License-Identifier: Apache-2.0
#include "rpc/tls_credentials.h"

#include <mutex>
#include <utility>

#include <grpc/grpc.h>
#include <grpc/grpc_security.h>
#include <grpcpp/security/auth_context.h>

#include "base/check.h"

namespace viewloom {
namespace {

grpc_ssl_client_certificate_request_type requestOf(const TlsMaterial& material) {
  if (material.client_authorities_pem.empty()) return GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE;
  return material.is_client_required ? GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY
                                     : GRPC_SSL_REQUEST_CLIENT_CERTIFICATE_AND_VERIFY;
}

// The certificates of grpc::SslServerCredentials stay for ever. Those of
// FileWatcherCertificateProvider follow their files, but a bad file ends all TLS of the port
// (gRPC 1.51). gRPC's core asks a function at each handshake, and keeps what it has when the
// function has nothing new; its C++ interface does not offer that, so this class does.
class ReloadingCredentials final : public grpc::ServerCredentials {
 public:
  explicit ReloadingCredentials(std::function<TlsMaterialPtr()> current)
      : current_(std::move(current)),
        core_(grpc_ssl_server_credentials_create_with_options(
            grpc_ssl_server_credentials_create_options_using_config_fetcher(
                requestOf(*current_()), &ReloadingCredentials::fetch, this))) {
    VIEWLOOM_CHECK(core_ != nullptr);
  }
  ~ReloadingCredentials() override { grpc_server_credentials_release(core_); }

  // Calls are judged where they arrive.
  void SetAuthMetadataProcessor(const std::shared_ptr<grpc::AuthMetadataProcessor>&) override {
    VIEWLOOM_CHECK(false);
  }

 private:
  int AddPortToServer(const std::string& address, grpc_server* server) override {
    return grpc_server_add_http2_port(server, address.c_str(), core_);
  }

  static grpc_ssl_certificate_config_reload_status fetch(
      void* self, grpc_ssl_server_certificate_config** config) {
    return static_cast<ReloadingCredentials*>(self)->fetch(config);
  }

  grpc_ssl_certificate_config_reload_status fetch(grpc_ssl_server_certificate_config** config) {
    const TlsMaterialPtr now = current_();
    std::lock_guard lock(mutex_);
    if (now == given_) return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_UNCHANGED;
    const grpc_ssl_pem_key_cert_pair pair{.private_key = now->certified_key.key_pem.c_str(),
                                          .cert_chain = now->certified_key.chain_pem.c_str()};
    // The core asks for authorities even where no client is asked for a certificate, and then
    // does not use them.
    const std::string& authorities = now->client_authorities_pem;
    *config = grpc_ssl_server_certificate_config_create(
        (authorities.empty() ? now->certified_key.chain_pem : authorities).c_str(), &pair, 1);
    given_ = now;
    return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_NEW;
  }

  const std::function<TlsMaterialPtr()> current_;
  std::mutex mutex_;  // of given_
  TlsMaterialPtr given_;
  grpc_server_credentials* const core_;
};

}  // namespace

std::shared_ptr<grpc::ServerCredentials> tlsServerCredentials(
    std::function<TlsMaterialPtr()> current) {
  return std::make_shared<ReloadingCredentials>(std::move(current));
}

std::string clientSubject(const grpc::ServerContextBase& call) {
  const std::shared_ptr<const grpc::AuthContext> shown = call.auth_context();
  if (shown == nullptr || !shown->IsPeerAuthenticated()) return "";
  const std::vector<grpc::string_ref> subjects =
      shown->FindPropertyValues(GRPC_X509_SUBJECT_PROPERTY_NAME);
  return subjects.empty() ? "" : std::string(subjects.front().begin(), subjects.front().end());
}

}  // namespace viewloom
