// SPDX-License-Identifier: Apache-2.0
#include "bridge/http_request.h"

#include <algorithm>
#include <future>
#include <optional>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/use_future.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include "base/host_port.h"
#include "base/str_cat.h"

namespace viewloom::bridge {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;

constexpr std::string_view kScheme = "http://";
constexpr unsigned kHttpVersion11 = 11;
constexpr uint64_t kBodyBytesMax = uint64_t{4} << 20;

bool isHostCharacter(char character) {
  return std::isalnum(static_cast<unsigned char>(character)) != 0 || character == '.' ||
         character == '-' || character == '_';
}

// Sets host and port, unless the text names no port.
bool readAuthority(std::string_view text, HttpAddress& address) {
  const std::optional<HostPort> parsed = parseHostPort(text);
  if (!parsed || parsed->port == 0) return false;
  const bool is_right =
      text.starts_with('[')
          ? parsed->host.find_first_not_of("0123456789abcdefABCDEF:.") == std::string::npos
          : std::all_of(parsed->host.begin(), parsed->host.end(), isHostCharacter);
  if (!is_right) return false;
  address.host = parsed->host;
  address.port = parsed->port.value_or(address.port);
  return true;
}

// Runs one operation to its end; throws its error.
template <typename Result>
Result finish(net::io_context& io, std::future<Result> operation) {
  io.restart();
  io.run();
  return operation.get();
}

HttpResponse exchangeOrThrow(const HttpAddress& address, const HttpRequest& request,
                             std::chrono::milliseconds timeout) {
  net::io_context io;
  net::ip::tcp::resolver resolver(io);
  const auto endpoints = resolver.resolve(address.host, std::to_string(address.port));
  beast::tcp_stream stream(io);
  stream.expires_after(timeout);
  finish(io, stream.async_connect(endpoints, net::use_future));

  http::request<http::string_body> message(http::string_to_verb(request.method), request.target,
                                           kHttpVersion11);
  message.set(http::field::host, address.url().substr(kScheme.size()));
  message.set(http::field::user_agent, "viewloom");
  message.keep_alive(false);
  if (!request.token.empty()) message.set(http::field::authorization, "Bearer " + request.token);
  if (!request.json.empty()) {
    message.set(http::field::content_type, "application/json");
    message.body() = request.json;
  }
  message.prepare_payload();
  finish(io, http::async_write(stream, message, net::use_future));

  http::response_parser<http::string_body> parser;
  parser.body_limit(kBodyBytesMax);
  beast::flat_buffer buffer;
  finish(io, http::async_read(stream, buffer, parser, net::use_future));
  http::response<http::string_body> answer = parser.release();
  const auto location = answer[http::field::location];
  return {.status = answer.result_int(),
          .location = std::string(location.data(), location.size()),
          .body = std::move(answer.body())};
}

absl::Status statusOf(const boost::system::error_code& error) {
  const std::string reason = error.message();
  if (error == beast::error::timeout) return absl::DeadlineExceededError(reason);
  const bool is_broken =
      error.category() == http::make_error_code(http::error::bad_method).category();
  return is_broken ? absl::DataLossError(reason) : absl::UnavailableError(reason);
}

}  // namespace

bool HttpAddress::isLoopback() const {
  return isLoopbackHost(host);
}

std::string HttpAddress::url() const {
  return strCat(std::string(kScheme), HostPort{.host = host, .port = port}.text());
}

absl::StatusOr<HttpAddress> parseHttpAddress(std::string_view text, uint16_t default_port,
                                             std::string_view option) {
  std::string_view rest = text;
  HttpAddress address{.host = "", .port = default_port};
  const bool has_scheme = rest.starts_with(kScheme);
  if (has_scheme) rest.remove_prefix(kScheme.size());
  if (rest.ends_with('/')) rest.remove_suffix(1);
  if (has_scheme && readAuthority(rest, address)) return address;
  return absl::InvalidArgumentError(strCat(std::string(option), ": got \"", std::string(text),
                                           "\"; accepted is http://HOST or http://HOST:PORT"));
}

absl::StatusOr<HttpResponse> exchange(const HttpAddress& address, const HttpRequest& request,
                                      std::chrono::milliseconds timeout) {
  try {
    return exchangeOrThrow(address, request, timeout);
  } catch (const boost::system::system_error& error) {
    return statusOf(error.code());
  }
}

}  // namespace viewloom::bridge
