// SPDX-License-Identifier: Apache-2.0
// The bytes of a connection, encrypted or not: one type for both, so that requests, viewers and
// players are written and compiled once.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "web/asio.h"

namespace viewloom {

// A stream as Beast takes it (AsyncReadStream, AsyncWriteStream). Begins without encryption.
// Thread-safety: none; all happens on the strand of its socket.
class WebStream {
 public:
  using executor_type = beast::tcp_stream::executor_type;

  explicit WebStream(tcp::socket socket) : stream_(beast::tcp_stream(std::move(socket))) {}

  executor_type get_executor() { return transport().get_executor(); }
  tcp::socket& socket() { return transport().socket(); }
  void close() { transport().close(); }
  // Subject of the certificate with which the client has proven itself, as Certificate::subject
  // writes it; empty = none.
  std::string clientSubject();

  // The clock of what begins after it: reads and writes that take longer fail.
  void expiresAfter(std::chrono::milliseconds limit) { transport().expires_after(limit); }
  void expiresNever() { transport().expires_never(); }

  // Shakes hands as a server of TLS. `begun` holds what was read already; it is used up.
  net::awaitable<void> secure(std::shared_ptr<ssl::context> context, beast::flat_buffer& begun,
                              ErrorCode& error);
  // Says that nothing more will be written, so that the other side knows it has everything.
  net::awaitable<void> finish(std::chrono::milliseconds limit);

  // The names that Beast asks for.
  template <typename Buffers, typename Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return net::async_initiate<Token, void(ErrorCode, size_t)>(
        [this](auto handler, const Buffers& into_buffers) {
          std::visit(
              [&](auto& stream) { stream.async_read_some(into_buffers, std::move(handler)); },
              stream_);
        },
        token, buffers);
  }
  template <typename Buffers, typename Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return net::async_initiate<Token, void(ErrorCode, size_t)>(
        [this](auto handler, const Buffers& from_buffers) {
          std::visit(
              [&](auto& stream) { stream.async_write_some(from_buffers, std::move(handler)); },
              stream_);
        },
        token, buffers);
  }

 private:
  using Secured = beast::ssl_stream<beast::tcp_stream>;

  template <typename Handler>
  friend void async_teardown(beast::role_type role, WebStream& stream, Handler&& handler);
  friend void teardown(beast::role_type role, WebStream& stream, ErrorCode& error);

  beast::tcp_stream& transport();

  std::shared_ptr<ssl::context> context_;  // outlives the stream
  std::variant<beast::tcp_stream, Secured> stream_;
};

// Ends of a WebSocket, which Beast finds by their names.
template <typename Handler>
void async_teardown(beast::role_type role, WebStream& stream, Handler&& handler) {
  std::visit(
      [&](auto& inner) {
        using websocket::async_teardown;
        async_teardown(role, inner, std::forward<Handler>(handler));
      },
      stream.stream_);
}
void teardown(beast::role_type role, WebStream& stream, ErrorCode& error);
inline void beast_close_socket(WebStream& stream) {
  stream.close();
}

}  // namespace viewloom
