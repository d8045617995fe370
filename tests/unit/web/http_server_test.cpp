// SPDX-License-Identifier: Apache-2.0
// A server whose parts throw goes on.
#include "web/http_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <ctime>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tls/make_certificate.h"
#include "unit/web/no_eyes.h"
#include "web/asio.h"

namespace viewloom::http_server_test {

using testing::HasSubstr;
using testing::Not;

constexpr std::string_view kWatch = "/ws?stream=room&preset=portrait&width=320&height=240";

class FailingParts : public testing::Test {
 protected:
  FailingParts() {
    broadcaster_.onDemandChange([this](const std::string&) { failIf(demand_fails_); });
  }

  static void failIf(std::atomic<bool>& fails) {
    if (fails.exchange(false)) throw std::runtime_error("planted");
  }
  void start(HttpOptions options = {}) {
    options.thread_count = 1;  // one that ends would leave none
    server_.emplace(std::move(options), streams_, broadcaster_, eyes_, metrics_, clock_, access_,
                    [this] {
                      failIf(health_fails_);
                      return absl::OkStatus();
                    });
  }
  tcp::socket connected() {
    tcp::socket socket(io_);
    socket.connect({net::ip::make_address("127.0.0.1"), server_->port()});
    return socket;
  }
  http::response<http::string_body> get(tcp::socket& socket, std::string_view target) {
    http::request<http::empty_body> request(http::verb::get, {target.data(), target.size()}, 11);
    request.set(http::field::host, "localhost");
    http::write(socket, request);
    beast::flat_buffer buffer;
    http::response<http::string_body> response;
    http::read(socket, buffer, response);
    return response;
  }
  std::unique_ptr<websocket::stream<tcp::socket>> watching() {
    auto viewer = std::make_unique<websocket::stream<tcp::socket>>(connected());
    viewer->handshake("localhost", {kWatch.data(), kWatch.size()});
    return viewer;
  }
  // A viewer that answers has begun to watch.
  static void expectPong(websocket::stream<tcp::socket>& viewer) {
    viewer.write(net::buffer(std::string(R"({"ping": 7})")));
    beast::flat_buffer buffer;
    viewer.read(buffer);
    EXPECT_THAT(beast::buffers_to_string(buffer.data()), HasSubstr("\"pong\":7"));
  }
  // Reads until the server closes.
  static websocket::close_code codeAtEnd(websocket::stream<tcp::socket>& viewer) {
    ErrorCode error;
    for (beast::flat_buffer buffer; !error; buffer.clear()) viewer.read(buffer, error);
    EXPECT_EQ(error, websocket::error::closed) << error.message();
    return websocket::close_code(viewer.reason().code);
  }
  void expectService() {
    tcp::socket socket = connected();
    EXPECT_EQ(get(socket, "/healthz").result_int(), 200U);
  }

  std::atomic<bool> demand_fails_ = false;
  std::atomic<bool> health_fails_ = false;
  const SteadyClock clock_;
  NoEyes eyes_;
  Metrics metrics_;
  StreamDirectory streams_{clock_, 8};
  Broadcaster broadcaster_{{}};
  AccessControl access_{clock_};
  const std::unique_ptr<StreamDirectory::Claim> room_ = *streams_.claim("room", "", [] {});
  std::optional<HttpServer> server_;
  net::io_context io_;
};

TEST_F(FailingParts, answersARequestThatThrewAndTheNextOne) {
  start();
  tcp::socket socket = connected();
  health_fails_ = true;
  const auto failed = get(socket, "/healthz");
  EXPECT_EQ(failed.result_int(), 500U);
  EXPECT_THAT(failed.body(), HasSubstr("the server failed while it answered this request"));
  EXPECT_THAT(failed.body(), Not(HasSubstr("planted")));
  EXPECT_EQ(get(socket, "/healthz").result_int(), 200U);
}

TEST_F(FailingParts, closesAWebSocketWhoseBeginThrew) {
  start();
  demand_fails_ = true;
  EXPECT_EQ(codeAtEnd(*watching()), websocket::close_code::internal_error);
  expectService();
}

TEST_F(FailingParts, closesAWebSocketWhoseChangeThrew) {
  start();
  const auto viewer = watching();
  const auto other = watching();
  expectPong(*viewer);
  expectPong(*other);  // both have begun to watch: the next change is that of the viewer
  demand_fails_ = true;
  viewer->write(net::buffer(
      std::string(R"({"change": {"display": {"quilt": {"preset": "portrait", "columns": 4}}}})")));
  EXPECT_EQ(codeAtEnd(*viewer), websocket::close_code::internal_error);
  expectPong(*other);
}

TEST_F(FailingParts, answersAPlayerWhoseBeginThrew) {
  start();
  demand_fails_ = true;
  tcp::socket socket = connected();
  const auto failed = get(socket, "/stream/room_qs4x2a1.mjpg?width=320&height=160");
  EXPECT_EQ(failed.result_int(), 500U);
  EXPECT_EQ(get(socket, "/healthz").result_int(), 200U);
}

TEST_F(FailingParts, closesAConnectionThatCannotBeTakenAndTakesTheNext) {
  const auto made = makeCertificate({.hosts = {"localhost"}, .now_s = std::time(nullptr)});
  const auto materialOf = [&](const std::string& key_pem) {
    auto chain = parseCertificates(made->certificate_pem);
    return std::make_shared<const TlsMaterial>(
        TlsMaterial{.certified_key = {.chain_pem = made->certificate_pem,
                                      .key_pem = key_pem,
                                      .certificate = std::move(chain->front())}});
  };
  const TlsMaterialPtr damaged = materialOf("damaged");
  const TlsMaterialPtr good = materialOf(made->key_pem);
  std::atomic<bool> is_damaged = true;
  HttpOptions options;
  options.tls = [&] { return is_damaged.exchange(false) ? damaged : good; };
  start(std::move(options));
  tcp::socket first = connected();
  ErrorCode error;
  char byte = 0;
  first.read_some(net::buffer(&byte, 1), error);
  EXPECT_TRUE(error) << "the connection was taken";
  tcp::socket second = connected();
  EXPECT_EQ(get(second, "/healthz").result_int(), 302U);  // to TLS
}

}  // namespace viewloom::http_server_test
