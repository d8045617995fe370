// SPDX-License-Identifier: Apache-2.0
#include "e2e/slow_line.h"

#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>

#include "support/loopback.h"
#include "support/socket_bytes.h"

namespace viewloom::test {
namespace {

constexpr int kTick_ms = 10;
// Kernel buffers on the way: what a line of a few hops holds. The kernel doubles them.
constexpr int kBufferBytes = 32 << 10;
// Bytes that may go at once after a pause, in milliseconds of the line.
constexpr double kBurst_ms = 20;

// Bytes that may go now; grows with time at the speed of the line.
class Allowance {
 public:
  size_t take(double bytes_per_ms) {
    const Clock::time_point now = Clock::now();
    const double passed_ms = std::chrono::duration<double, std::milli>(now - since_).count();
    since_ = now;
    bytes_ = std::min(bytes_ + passed_ms * bytes_per_ms, kBurst_ms * bytes_per_ms);
    return size_t(bytes_);
  }
  void spend(size_t bytes) { bytes_ -= double(bytes); }

 private:
  using Clock = std::chrono::steady_clock;

  Clock::time_point since_ = Clock::now();
  double bytes_ = 0;
};

}  // namespace

SlowLine::SlowLine(const std::string& server_address, double mbit_per_second)
    : server_port_(portIn(server_address)),
      listener_(listenAnywhere()),
      acceptor_([this](const std::stop_token& stop) { accept(stop); }) {
  setSpeed(mbit_per_second);
}

SlowLine::~SlowLine() {
  acceptor_ = {};
  passers_.clear();
  close(listener_);
}

std::string SlowLine::address() const {
  return addressOf(listener_);
}

void SlowLine::accept(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (!isReadable(listener_, kTick_ms)) continue;
    const int client = ::accept(listener_, nullptr, nullptr);
    const int server = socket(AF_INET, SOCK_STREAM, 0);
    setsockopt(server, SOL_SOCKET, SO_RCVBUF, &kBufferBytes, sizeof(kBufferBytes));
    setsockopt(client, SOL_SOCKET, SO_SNDBUF, &kBufferBytes, sizeof(kBufferBytes));
    const int on = 1;
    for (const int fd : {client, server}) {
      setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
    }
    if (!connectTo(server, server_port_)) {
      close(client);
      close(server);
      continue;
    }
    passers_.emplace_back(
        [this, client, server](const std::stop_token& passing) { pass(passing, client, server); });
  }
}

void SlowLine::pass(const std::stop_token& stop, int client, int server) {
  {
    const std::jthread to_server([&] {
      std::vector<uint8_t> bytes(1 << 16);
      while (!stop.stop_requested()) {
        if (!isReadable(client, kTick_ms)) continue;
        const ssize_t count = recv(client, bytes.data(), bytes.size(), 0);
        if (count <= 0 || !sendAll(server, bytes.data(), size_t(count))) break;
      }
      shutdown(server, SHUT_RDWR);
    });
    std::vector<uint8_t> bytes(1 << 16);
    Allowance allowance;
    while (!stop.stop_requested()) {
      if (!isReadable(server, kTick_ms)) continue;
      const size_t allowed = std::min(allowance.take(bytes_per_ms_), bytes.size());
      if (allowed == 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        continue;
      }
      const ssize_t count = recv(server, bytes.data(), allowed, 0);
      if (count <= 0 || !sendAll(client, bytes.data(), size_t(count))) break;
      allowance.spend(size_t(count));
    }
    shutdown(client, SHUT_RDWR);
    shutdown(server, SHUT_RDWR);
  }
  close(client);
  close(server);
}

}  // namespace viewloom::test
