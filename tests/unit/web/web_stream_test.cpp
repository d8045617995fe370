// SPDX-License-Identifier: Apache-2.0
#include "web/web_stream.h"

#include <array>
#include <ctime>
#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <boost/asio/detached.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/ssl/stream.hpp>

#include "tls/make_certificate.h"
#include "tls/tls_material.h"
#include "web/tls_contexts.h"

namespace viewloom::web_stream_test {
namespace {

using std::chrono_literals::operator""s;

TlsMaterialPtr makeMaterial() {
  const auto made = makeCertificate({.hosts = {"localhost"}, .now_s = std::time(nullptr)});
  auto chain = parseCertificates(made->certificate_pem);
  return std::make_shared<const TlsMaterial>(
      TlsMaterial{.certified_key = {.chain_pem = made->certificate_pem,
                                    .key_pem = made->key_pem,
                                    .certificate = std::move(chain->front())}});
}

// Takes one connection, answers with what it sends first, and says goodbye.
net::awaitable<void> answerOne(tcp::acceptor& acceptor, std::shared_ptr<ssl::context> context) {
  WebStream stream(co_await acceptor.async_accept(net::use_awaitable));
  beast::flat_buffer begun;
  ErrorCode error;
  stream.expiresAfter(10s);
  const bool speaks_tls = co_await beast::async_detect_ssl(stream, begun, into(error));
  if (speaks_tls) co_await stream.secure(std::move(context), begun, error);
  if (error) co_return;                 // the other side shows whether that is right
  WebStream moved = std::move(stream);  // as viewers take it
  std::array<char, 16> bytes{};
  size_t count = begun.size();
  net::buffer_copy(net::buffer(bytes), begun.data());
  if (count == 0) count = co_await moved.async_read_some(net::buffer(bytes), into(error));
  co_await net::async_write(moved, net::buffer(bytes.data(), count), into(error));
  EXPECT_FALSE(error) << error.message();
  co_await moved.finish(1s);
}

// All that comes until the other side says goodbye.
template <typename Stream>
net::awaitable<std::string> exchange(Stream& stream, ErrorCode& end) {
  co_await net::async_write(stream, net::buffer("hello", 5), net::use_awaitable);
  std::string answer;
  co_await net::async_read(stream, net::dynamic_buffer(answer), into(end));
  co_return answer;
}

class WebStreamTest : public testing::Test {
 protected:
  // Runs both sides, with `talk` as the client.
  void run(std::function<net::awaitable<void>(tcp::socket)> talk) {
    tcp::acceptor acceptor(io_, {net::ip::make_address("127.0.0.1"), 0});
    TlsContexts contexts([material = makeMaterial()] { return material; });
    const auto context = contexts.current();
    EXPECT_EQ(contexts.current(), context);
    net::co_spawn(io_, answerOne(acceptor, context), net::detached);
    tcp::socket socket(io_);
    socket.connect(acceptor.local_endpoint());
    net::co_spawn(io_, talk(std::move(socket)), net::detached);
    io_.run();
  }

  net::io_context io_;
  std::string answer_;
  ErrorCode end_;
};

TEST_F(WebStreamTest, carriesBytesWithoutTls) {
  run([this](tcp::socket socket) -> net::awaitable<void> {
    answer_ = co_await exchange(socket, end_);
  });
  EXPECT_EQ(answer_, "hello");
  EXPECT_EQ(end_, net::error::eof);
}

TEST_F(WebStreamTest, carriesBytesWithTlsAndSaysGoodbye) {
  run([this](tcp::socket socket) -> net::awaitable<void> {
    ssl::context trusting(ssl::context::tls_client);
    ssl::stream<tcp::socket> stream(std::move(socket), trusting);
    co_await stream.async_handshake(ssl::stream_base::client, net::use_awaitable);
    EXPECT_EQ(std::string(SSL_get_version(stream.native_handle())), "TLSv1.3");
    answer_ = co_await exchange(stream, end_);
    ErrorCode ignored;
    co_await stream.async_shutdown(into(ignored));
  });
  EXPECT_EQ(answer_, "hello");
  EXPECT_EQ(end_, net::error::eof);  // not stream_truncated
}

TEST_F(WebStreamTest, refusesTlsBefore12) {
  ErrorCode refusal;
  run([&refusal](tcp::socket socket) -> net::awaitable<void> {
    ssl::context old(ssl::context::tls_client);
    SSL_CTX_set_security_level(old.native_handle(), 0);
    SSL_CTX_set_max_proto_version(old.native_handle(), TLS1_1_VERSION);
    ssl::stream<tcp::socket> stream(std::move(socket), old);
    co_await stream.async_handshake(ssl::stream_base::client, into(refusal));
  });
  EXPECT_TRUE(refusal);
}

}  // namespace
}  // namespace viewloom::web_stream_test
