// SPDX-License-Identifier: Apache-2.0
#include "web/web_stream.h"

#include "certificates/certificate.h"

namespace viewloom {

beast::tcp_stream& WebStream::transport() {
  if (auto* const plain = std::get_if<beast::tcp_stream>(&stream_)) return *plain;
  return std::get<Secured>(stream_).next_layer();
}

net::awaitable<void> WebStream::secure(std::shared_ptr<ssl::context> context,
                                       beast::flat_buffer& begun, ErrorCode& error) {
  context_ = std::move(context);
  beast::tcp_stream plain = std::move(std::get<beast::tcp_stream>(stream_));
  Secured& secured = stream_.emplace<Secured>(std::move(plain), *context_);
  const size_t used =
      co_await secured.async_handshake(ssl::stream_base::server, begun.data(), into(error));
  begun.consume(used);
}

net::awaitable<void> WebStream::finish(std::chrono::milliseconds limit) {
  ErrorCode ignored;
  if (auto* const secured = std::get_if<Secured>(&stream_)) {
    expiresAfter(limit);
    co_await secured->async_shutdown(into(ignored));
  }
  socket().shutdown(tcp::socket::shutdown_send, ignored);
}

std::string WebStream::clientSubject() {
  auto* const secured = std::get_if<Secured>(&stream_);
  if (secured == nullptr) return "";
  OpensslPtr<X509> shown(SSL_get1_peer_certificate(secured->native_handle()));
  return shown == nullptr ? "" : Certificate(std::move(shown)).subject();
}

void teardown(beast::role_type role, WebStream& stream, ErrorCode& error) {
  std::visit(
      [&](auto& inner) {
        using websocket::teardown;
        teardown(role, inner, error);
      },
      stream.stream_);
}

}  // namespace viewloom
