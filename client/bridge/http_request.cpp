// SPDX-License-Identifier: Apache-2.0
#include "bridge/http_request.h"

#include <algorithm>
#include <charconv>
#include <future>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/use_future.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

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

bool readPort(std::string_view text, uint16_t& port) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc() && end == text.data() + text.size() && port > 0;
}

// HOST, HOST:PORT, [IPV6] or [IPV6]:PORT.
bool readAuthority(std::string_view text, HttpAddress& address) {
  size_t end = text.find(':');
  if (text.starts_with('[')) {
    end = text.find(']');
    if (end == std::string_view::npos) return false;
    address.host = text.substr(1, end - 1);
    if (address.host.find_first_not_of("0123456789abcdefABCDEF:.") != std::string::npos) {
      return false;
    }
    text.remove_prefix(end + 1);
  } else {
    address.host = text.substr(0, end);
    if (!std::all_of(address.host.begin(), address.host.end(), isHostCharacter)) return false;
    text.remove_prefix(address.host.size());
  }
  if (address.host.empty()) return false;
  return text.empty() || (text.front() == ':' && readPort(text.substr(1), address.port));
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
  return host == "localhost" || host == "::1" || host.starts_with("127.");
}

std::string HttpAddress::url() const {
  const bool is_ipv6 = host.find(':') != std::string::npos;
  return strCat(std::string(kScheme), is_ipv6 ? "[" : "", host, is_ipv6 ? "]" : "", ":", port);
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
