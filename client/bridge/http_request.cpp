// SPDX-License-Identifier: Apache-2.0
#include "bridge/http_request.h"

#include <algorithm>
#include <exception>
#include <future>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/use_future.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>

#include "base/host_port.h"
#include "base/str_cat.h"
#include "certificates/certificate.h"

namespace viewloom::bridge {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;

constexpr unsigned kHttpVersion11 = 11;
constexpr uint64_t kBodyBytesMax = uint64_t{4} << 20;

std::string_view schemeOf(const TlsParts* tls) {
  return tls == nullptr ? "http://" : "https://";
}

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

constexpr std::chrono::milliseconds kTick{20};  // how soon a caller that gives up is heard

using Endpoints = net::ip::tcp::resolver::results_type;

// One exchange: what its operations run on, and when they are over.
class Exchange {
 public:
  Exchange(net::io_context& io, const Patience& patience)
      : io_(io), patience_(patience), end_(std::chrono::steady_clock::now() + patience.timeout) {}

  std::chrono::steady_clock::time_point end() const { return end_; }

  void throwIfOver() const {
    throwIfGivenUp();
    if (std::chrono::steady_clock::now() >= end_) {
      throw boost::system::system_error(beast::error::timeout);
    }
  }

  // Runs one operation of the stream to its end; throws its error.
  template <typename Result>
  Result finish(beast::tcp_stream& stream, std::future<Result> operation) {
    io_.restart();
    while (!io_.stopped()) {
      io_.run_for(kTick);
      if (hasGivenUp()) stream.close();  // ends the operation
    }
    throwIfGivenUp();
    return operation.get();
  }

 private:
  bool hasGivenUp() const { return patience_.has_given_up && patience_.has_given_up(); }
  void throwIfGivenUp() const {
    if (hasGivenUp()) throw boost::system::system_error(net::error::operation_aborted);
  }

  net::io_context& io_;
  const Patience& patience_;
  const std::chrono::steady_clock::time_point end_;
};

// Looks up a name. A look-up cannot be broken off, so one that lasts too long is left to its
// thread.
Endpoints resolved(const HttpAddress& address, const Exchange& exchange) {
  std::promise<Endpoints> promise;
  std::future<Endpoints> found = promise.get_future();
  std::thread([promise = std::move(promise), host = address.host,
               port = std::to_string(address.port)]() mutable {
    try {
      net::io_context io;
      promise.set_value(net::ip::tcp::resolver(io).resolve(host, port));
    } catch (...) {
      promise.set_exception(std::current_exception());
    }
  }).detach();
  while (found.wait_for(kTick) != std::future_status::ready) exchange.throwIfOver();
  return found.get();
}

http::request<http::string_body> messageOf(const HttpAddress& address, const HttpRequest& request) {
  http::request<http::string_body> message(http::string_to_verb(request.method), request.target,
                                           kHttpVersion11);
  message.set(http::field::host, HostPort{.host = address.host, .port = address.port}.text());
  message.set(http::field::user_agent, "viewloom");
  message.keep_alive(false);
  if (!request.token.empty()) message.set(http::field::authorization, "Bearer " + request.token);
  if (!request.json.empty()) {
    message.set(http::field::content_type, "application/json");
    message.body() = request.json;
  }
  message.prepare_payload();
  return message;
}

template <typename Stream>
HttpResponse talk(Exchange& exchange, Stream& stream,
                  const http::request<http::string_body>& message) {
  beast::tcp_stream& plain = beast::get_lowest_layer(stream);
  exchange.finish(plain, http::async_write(stream, message, net::use_future));
  http::response_parser<http::string_body> parser;
  parser.body_limit(kBodyBytesMax);
  beast::flat_buffer buffer;
  exchange.finish(plain, http::async_read(stream, buffer, parser, net::use_future));
  http::response<http::string_body> answer = parser.release();
  const auto location = answer[http::field::location];
  return {.status = answer.result_int(),
          .location = std::string(location.data(), location.size()),
          .body = std::move(answer.body())};
}

// Certificates that the server has shown, its own first.
std::vector<Certificate> chainOf(SSL* connection) {
  std::vector<Certificate> chain;
  STACK_OF(X509)* const shown = SSL_get_peer_cert_chain(connection);
  for (int i = 0; i < sk_X509_num(shown); ++i) {
    X509* const certificate = sk_X509_value(shown, i);
    X509_up_ref(certificate);
    chain.emplace_back(OpensslPtr<X509>(certificate));
  }
  return chain;
}

// The handshake proves that the server has the key of its certificate; TlsParts::judge says whose
// certificate it is.
absl::StatusOr<HttpResponse> talkEncrypted(Exchange& exchange, beast::tcp_stream plain,
                                           const HttpAddress& address,
                                           const http::request<http::string_body>& message) {
  const TlsParts& parts = *address.tls;
  net::ssl::context context(net::ssl::context::tls_client);
  SSL_CTX_set_min_proto_version(context.native_handle(), TLS1_2_VERSION);
  if (parts.own) {
    context.use_certificate_chain(net::buffer(parts.own->chain_pem));
    context.use_private_key(net::buffer(parts.own->key_pem), net::ssl::context::pem);
  }
  beast::ssl_stream<beast::tcp_stream> stream(std::move(plain), context);
  stream.set_verify_mode(net::ssl::verify_none);
  boost::system::error_code no_address;
  net::ip::make_address(address.host, no_address);
  if (no_address) SSL_set_tlsext_host_name(stream.native_handle(), address.host.c_str());
  exchange.finish(beast::get_lowest_layer(stream),
                  stream.async_handshake(net::ssl::stream_base::client, net::use_future));
  VIEWLOOM_RETURN_IF_ERROR(parts.judge(chainOf(stream.native_handle()), address.host));
  return talk(exchange, stream, message);
}

absl::StatusOr<HttpResponse> exchangeOrThrow(const HttpAddress& address, const HttpRequest& request,
                                             const Patience& patience) {
  net::io_context io;
  Exchange exchange(io, patience);
  exchange.throwIfOver();
  const Endpoints endpoints = resolved(address, exchange);
  beast::tcp_stream stream(io);
  stream.expires_at(exchange.end());
  exchange.finish(stream, stream.async_connect(endpoints, net::use_future));
  const http::request<http::string_body> message = messageOf(address, request);
  if (address.tls == nullptr) return talk(exchange, stream, message);
  return talkEncrypted(exchange, std::move(stream), address, message);
}

absl::Status statusOf(const boost::system::error_code& error) {
  const std::string reason = error.message();
  if (error == net::error::operation_aborted) return absl::CancelledError("given up");
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
  return strCat(std::string(schemeOf(tls.get())), HostPort{.host = host, .port = port}.text());
}

absl::StatusOr<HttpAddress> parseHttpAddress(std::string_view text, uint16_t default_port,
                                             std::string_view option,
                                             std::shared_ptr<const TlsParts> tls) {
  std::string_view rest = text;
  const std::string scheme(schemeOf(tls.get()));
  HttpAddress address{.host = "", .port = default_port, .tls = std::move(tls)};
  const bool has_scheme = rest.starts_with(scheme);
  if (has_scheme) rest.remove_prefix(scheme.size());
  if (rest.ends_with('/')) rest.remove_suffix(1);
  if (has_scheme && readAuthority(rest, address)) return address;
  return absl::InvalidArgumentError(strCat(std::string(option), ": got \"", std::string(text),
                                           "\"; accepted is ", scheme, "HOST or ", scheme,
                                           "HOST:PORT"));
}

absl::StatusOr<HttpResponse> exchange(const HttpAddress& address, const HttpRequest& request,
                                      const Patience& patience) {
  try {
    return exchangeOrThrow(address, request, patience);
  } catch (const boost::system::system_error& error) {
    return statusOf(error.code());
  }
}

}  // namespace viewloom::bridge
