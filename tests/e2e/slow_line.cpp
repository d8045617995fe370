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

// Kernel buffers on the way: what a line of a few hops holds. The kernel doubles them.
constexpr int kBufferBytes = 32 << 10;
// Bytes that may go at once after a pause, in milliseconds of the line.
constexpr double kBurst_ms = 20;

void sendAtOnce(int socket) {
  const int on = 1;
  setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
}

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

int dial(uint16_t server_port) {
  const int server = socket(AF_INET, SOCK_STREAM, 0);
  setsockopt(server, SOL_SOCKET, SO_RCVBUF, &kBufferBytes, sizeof(kBufferBytes));
  sendAtOnce(server);
  if (connectTo(server, server_port)) return server;
  close(server);
  return -1;
}

}  // namespace

SlowLine::SlowLine(const std::string& server_address, double mbit_per_second)
    : proxy_(
          listenAnywhere(), [port = portIn(server_address)] { return dial(port); },
          [this](const std::stop_token& stop, int server, int client) {
            passBack(stop, server, client);
          }) {
  setSpeed(mbit_per_second);
}

std::string SlowLine::address() const {
  return addressOf(proxy_.listener());
}

void SlowLine::passBack(const std::stop_token& stop, int server, int client) const {
  setsockopt(client, SOL_SOCKET, SO_SNDBUF, &kBufferBytes, sizeof(kBufferBytes));
  sendAtOnce(client);
  std::vector<uint8_t> bytes(1 << 16);
  Allowance allowance;
  while (!stop.stop_requested()) {
    if (!isReadable(server, kProxyTick_ms)) continue;
    const size_t allowed = std::min(allowance.take(bytes_per_ms_), bytes.size());
    if (allowed == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    const ssize_t count = recv(server, bytes.data(), allowed, 0);
    if (count <= 0 || !sendAll(client, bytes.data(), size_t(count))) return;
    allowance.spend(size_t(count));
  }
}

}  // namespace viewloom::test
