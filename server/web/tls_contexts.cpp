// SPDX-License-Identifier: Apache-2.0
#include "web/tls_contexts.h"

#include <utility>

namespace viewloom {
namespace {

// Throws boost::system::system_error; the material was checked, so that is for want of memory.
std::shared_ptr<ssl::context> makeContext(const TlsMaterial& material) {
  auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  SSL_CTX* const settings = context->native_handle();
  SSL_CTX_set_min_proto_version(settings, TLS1_2_VERSION);
  // A resumed session would keep what a certificate has proved, also after its authority has gone.
  SSL_CTX_set_session_cache_mode(settings, SSL_SESS_CACHE_OFF);
  SSL_CTX_set_options(settings,
                      SSL_OP_NO_TICKET | SSL_OP_NO_RENEGOTIATION | SSL_OP_CIPHER_SERVER_PREFERENCE);
  SSL_CTX_set_num_tickets(settings, 0);
  context->use_certificate_chain(net::buffer(material.certified_key.chain_pem));
  context->use_private_key(net::buffer(material.certified_key.key_pem), ssl::context::pem);
  if (material.client_authorities_pem.empty()) return context;
  context->add_certificate_authority(net::buffer(material.client_authorities_pem));
  context->set_verify_mode(material.is_client_required
                               ? ssl::verify_peer | ssl::verify_fail_if_no_peer_cert
                               : ssl::verify_peer);
  return context;
}

}  // namespace

TlsContexts::TlsContexts(std::function<TlsMaterialPtr()> material)
    : material_(std::move(material)) {}

std::shared_ptr<ssl::context> TlsContexts::current() {
  TlsMaterialPtr now = material_();
  if (now == used_) return context_;
  context_ = makeContext(*now);
  used_ = std::move(now);
  return context_;
}

}  // namespace viewloom
