// SPDX-License-Identifier: Apache-2.0
#include "web/connection.h"

#include <chrono>
#include <utility>
#include <vector>

#include "admission/request_boundary.h"
#include "base/send_queue.h"
#include "web/admission.h"
#include "web/http_wire.h"
#include "web/live_answer.h"
#include "web/once_ended.h"
#include "web/session.h"
#include "web/viewer.h"

namespace viewloom {
namespace {

constexpr unsigned kNotModified = 304;
// For the other side to confirm the end of an encrypted connection.
constexpr std::chrono::milliseconds kGoodbyeTime{1000};

std::string text(beast::string_view view) {
  return std::string(view.data(), view.size());
}

std::string addressOf(const tcp::socket& socket) {
  ErrorCode error;
  const tcp::endpoint peer = socket.remote_endpoint(error);
  return error ? "" : peer.address().to_string();
}

}  // namespace

Connection::Connection(WebContext& context, tcp::socket socket, ConnectionPlace place,
                       std::shared_ptr<ssl::context> tls)
    : context_(context),
      place_(std::move(place)),
      strand_(socket.get_executor()),
      tls_(std::move(tls)),
      stream_(std::move(socket)),
      peer_(addressOf(stream_.socket())),
      host_(peer_) {
  ErrorCode ignored;  // a socket that is gone already shows at the first read
  stream_.socket().set_option(tcp::no_delay(true), ignored);
  limitSendQueue(stream_.socket().native_handle());
  context_.metrics.http_connections.add(1);
}

Connection::~Connection() {
  context_.metrics.http_connections.add(-1);
}

HttpRequest Connection::requestOf(const http::request<http::empty_body>& request) const {
  return {.method = text(request.method_string()),
          .target = text(request.target()),
          .peer = peer_,
          .client_host = host_,
          .host = text(request[http::field::host]),
          .if_none_match = text(request[http::field::if_none_match]),
          .authorization = text(request[http::field::authorization]),
          .cookie = text(request[http::field::cookie]),
          .websocket_protocols = text(request[http::field::sec_websocket_protocol]),
          .page = {.origin = text(request[http::field::origin]),
                   .referer = text(request[http::field::referer]),
                   .fetch_site = text(request["Sec-Fetch-Site"]),
                   .fetch_mode = text(request["Sec-Fetch-Mode"]),
                   .fetch_dest = text(request["Sec-Fetch-Dest"])},
          .is_encrypted = context_.options.tls || request["X-Forwarded-Proto"] == "https",
          .upgrade = websocket::is_upgrade(request)};
}

void Connection::start() {
  const auto self = shared_from_this();
  net::co_spawn(
      strand_, [self] { return self->serve(); }, OnceEnded([self] { self->end(); }));
}

void Connection::leave() {
  net::post(strand_, [self = shared_from_this()] {
    if (self->live_reader_) {
      self->live_reader_->leave();
    } else if (self->idle_) {
      self->stream_.close();
    }
  });
}

void Connection::cut() {
  awaits_request_ = false;
  net::post(strand_, [self = shared_from_this()] { self->end(); });
}

void Connection::end() {
  if (live_reader_) {
    live_reader_->cut();
  } else {
    stream_.close();
  }
}

net::awaitable<void> Connection::serve() {
  const auto self = shared_from_this();
  if (!co_await secure()) co_return;
  for (bool keep = true; keep;) {
    Parser parser;
    ErrorCode error;
    co_await read(parser, error);
    if (error) {
      if (const auto reply = replyToBroken(error)) {
        co_await write(*reply, parser, false, error);
      }
      break;
    }
    const HttpRequest request = requestOf(parser.get());
    std::optional<HttpReply> reply = refusalOf(request);
    if (!reply && request.upgrade) {
      co_await watch(parser, request);
      co_return;
    }
    if (!reply) reply = co_await replyTo(request);
    const bool is_played = reply->live && parser.get().method() != http::verb::head;
    if (is_played && co_await play(*reply)) co_return;
    keep =
        parser.get().keep_alive() && !context_.draining && place_.admission != Admission::kStatus;
    co_await write(*reply, parser, keep, error);
    if (error) break;
  }
  co_await stream_.finish(kGoodbyeTime);
}

std::optional<HttpReply> Connection::refusalOf(const HttpRequest& request) const {
  if (place_.admission == Admission::kStatus && !isStatusTarget(request.target)) {
    context_.metrics.connections_refused[Transport::kWeb].add();
    return errorReply(
        absl::ResourceExhaustedError("too many connections; close some, or try again later"));
  }
  return refusal(context_, request);
}

std::chrono::milliseconds Connection::requestTimeout() const {
  return place_.admission == Admission::kStatus ? context_.options.status_timeout
                                                : context_.options.request_timeout;
}

net::awaitable<bool> Connection::secure() {
  if (tls_ == nullptr) co_return true;
  ErrorCode error;
  idle_ = true;
  stream_.expiresAfter(requestTimeout());
  const bool speaks_tls = co_await beast::async_detect_ssl(stream_, buffer_, into(error));
  if (!error && !speaks_tls) co_await sendToTls();
  if (error || !speaks_tls) co_return false;
  idle_ = false;
  co_await stream_.secure(std::exchange(tls_, nullptr), buffer_, error);
  if (error) co_return false;
  // Clients with one certificate are one user's, wherever they run.
  if (std::string subject = stream_.clientSubject(); !subject.empty()) host_ = std::move(subject);
  co_return true;
}

// People write addresses without https://, and browsers then begin without TLS.
net::awaitable<void> Connection::sendToTls() {
  Parser parser;
  ErrorCode error;
  co_await read(parser, error);
  if (error) co_return;
  const HttpRequest request = requestOf(parser.get());
  std::optional<HttpReply> reply = refusalOf(request);
  if (!reply) reply = redirectToTls(request);
  co_await write(*reply, parser, false, error);
}

net::awaitable<void> Connection::read(Parser& parser, ErrorCode& error) {
  parser.header_limit(context_.options.header_bytes_max);
  parser.body_limit(0);
  idle_ = buffer_.size() == 0;
  if (idle_ && context_.draining) {
    error = net::error::operation_aborted;
    co_return;
  }
  stream_.expiresAfter(requestTimeout());
  awaits_request_ = true;
  co_await http::async_read_header(stream_, buffer_, parser, into(error));
  idle_ = false;
  if (!error) co_await http::async_read(stream_, buffer_, parser, into(error));
  awaits_request_ = false;
}

net::awaitable<HttpReply> Connection::replyTo(HttpRequest request) {
  try {
    co_return co_await answer(context_, std::move(request));
  } catch (const std::exception& thrown) {
    co_return errorReply(refusalFor(thrown));
  }
}

net::awaitable<void> Connection::watch(Parser& parser, const HttpRequest& request) {
  const absl::StatusOr<Url> url = parseUrl(request.target);
  ErrorCode error;
  if (!url.ok() || url->path != kWebSocket) {
    const HttpReply reply = co_await replyTo(request);
    co_await write(reply, parser, false, error);
    co_return;
  }
  absl::StatusOr<Caller> caller = unlessThrown([&]() -> absl::StatusOr<Caller> {
    absl::StatusOr<Caller> admitted = admitViewer(context_, request, *url);
    VIEWLOOM_RETURN_IF_ERROR(admitted.status());
    VIEWLOOM_RETURN_IF_ERROR(admitted->stay());
    return admitted;
  });
  if (!caller.ok()) {
    const HttpReply reply = errorReply(caller.status());
    co_await write(reply, parser, false, error);
    co_return;
  }
  const std::string identity = caller->shareName(host_);
  const auto viewer = std::make_shared<Viewer>(context_, *std::move(caller), std::move(stream_),
                                               url->parameters, identity);
  live_reader_ = viewer;
  if (context_.draining) viewer->leave();
  // Chosen before: GCC 12 destroys what a condition in a co_await makes twice.
  std::string protocol = offersProtocol(request) ? std::string(kWebSocketProtocol) : "";
  co_await viewer->run(parser.release(), std::move(protocol));
}

net::awaitable<bool> Connection::play(HttpReply& reply) {
  Caller& caller = reply.live->caller;
  std::shared_ptr<LiveStream> player;
  const absl::Status status = unlessThrown([&]() -> absl::Status {
    VIEWLOOM_RETURN_IF_ERROR(caller.stay());
    player = makeLiveStream(context_, *reply.live, strand_, caller.shareName(host_));
    return player->subscribe(reply.live->request);
  });
  if (!status.ok()) {
    reply = errorReply(status);
    co_return false;
  }
  live_reader_ = player;
  if (context_.draining) player->leave();
  http::response<http::empty_body> head = headOf(reply);
  head.keep_alive(false);
  context_.metrics.http_responses[HttpAnswer::kSuccess].add();
  co_await player->run(std::move(stream_), std::move(head));
  co_return true;
}

net::awaitable<void> Connection::write(const HttpReply& reply, const Parser& parser, bool keep,
                                       ErrorCode& error) {
  const std::vector<net::const_buffer> body = bodyOf(reply);
  http::response<http::empty_body> response = headOf(reply);
  if (reply.status != kNotModified && !reply.live) response.content_length(net::buffer_size(body));
  response.keep_alive(keep);
  http::response_serializer<http::empty_body> serializer(response);
  stream_.expiresAfter(context_.options.transfer_timeout);
  co_await http::async_write_header(stream_, serializer, into(error));
  context_.metrics.http_responses[answerKind(reply.status)].add();
  if (error || parser.get().method() == http::verb::head || reply.status == kNotModified) co_return;
  co_await net::async_write(stream_, body, into(error));
}

}  // namespace viewloom
