// SPDX-License-Identifier: Apache-2.0
// One connection of the web server, from its first request to its end.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "admission/memory_budget.h"
#include "web/asio.h"
#include "web/http_reply.h"
#include "web/live_reader.h"
#include "web/routes.h"
#include "web/web_context.h"
#include "web/web_stream.h"

namespace viewloom {

// Requests that a connection may make.
enum class Admission : uint8_t {
  kEverything,
  kStatus,  // one request: /healthz and /metrics; the rest is answered "too many connections"
};

// A connection among all of them.
struct ConnectionPlace {
  Admission admission = Admission::kEverything;
  Reservation memory;  // of the connection itself
};

// Thread-safety: start(), leave(), cut() and awaitsRequest() may be called from any thread; the
// rest happens on the strand of its socket.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  // `tls`: what it is encrypted with; null = not at all.
  Connection(WebContext& context, tcp::socket socket, ConnectionPlace place,
             std::shared_ptr<ssl::context> tls);
  ~Connection();

  // Serves requests until either side goes; stays alive by itself until then.
  void start();
  // The server drains: ends as soon as what is under way is answered.
  void leave();
  // Ends at once, and awaits nothing any more.
  void cut();
  // Whether the client has to send something next: it holds a place and gets nothing for it.
  bool awaitsRequest() const { return awaits_request_; }

 private:
  using Parser = http::request_parser<http::empty_body>;

  // Cuts, on the strand.
  void end();
  net::awaitable<void> serve();
  // False when the other side goes, or speaks no TLS and was told so.
  net::awaitable<bool> secure();
  net::awaitable<void> sendToTls();
  // For a handshake, and for a request.
  std::chrono::milliseconds requestTimeout() const;
  net::awaitable<void> read(Parser& parser, ErrorCode& error);
  // Refuses what the client is not admitted to.
  std::optional<HttpReply> refusalOf(const HttpRequest& request) const;
  // The reply, or that the server has failed at it.
  net::awaitable<HttpReply> replyTo(HttpRequest request);
  net::awaitable<void> watch(Parser& parser, const HttpRequest& request);
  // True when the connection went to the player; else nothing was written, and `reply` says why.
  net::awaitable<bool> play(HttpReply& reply);
  net::awaitable<void> write(const HttpReply& reply, const Parser& parser, bool keep,
                             ErrorCode& error);

  HttpRequest requestOf(const http::request<http::empty_body>& request) const;

  WebContext& context_;
  const ConnectionPlace place_;
  const net::any_io_executor strand_;
  std::shared_ptr<ssl::context> tls_;  // null once it is in use, or where there is none
  WebStream stream_;                   // until a live reader has it
  const std::string peer_;             // address of the client; empty if it is gone already
  std::string host_;                   // the same, or the subject of the client's certificate
  beast::flat_buffer buffer_;
  std::shared_ptr<LiveReader> live_reader_;
  bool idle_ = false;  // waits for a request of which nothing has come
  std::atomic<bool> awaits_request_ = true;
};

}  // namespace viewloom
