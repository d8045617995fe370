// SPDX-License-Identifier: Apache-2.0
#include "support/proxy.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <utility>

#include "support/socket_bytes.h"

namespace viewloom::test {
namespace {

void passOn(const std::stop_token& stop, int from, int to) {
  std::vector<uint8_t> bytes(1 << 16);
  while (!stop.stop_requested()) {
    if (!isReadable(from, kProxyTick_ms)) continue;
    const ssize_t count = recv(from, bytes.data(), bytes.size(), 0);
    if (count <= 0 || !sendAll(to, bytes.data(), size_t(count))) return;
  }
}

}  // namespace

Proxy::Proxy(int listener, Dial dial, PassBack pass_back)
    : listener_(listener),
      dial_(std::move(dial)),
      pass_back_(std::move(pass_back)),
      acceptor_([this](const std::stop_token& stop) { accept(stop); }) {}

Proxy::~Proxy() {
  acceptor_ = {};
  passers_.clear();
  close(listener_);
}

void Proxy::accept(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (!isReadable(listener_, kProxyTick_ms)) continue;
    const int client = ::accept(listener_, nullptr, nullptr);
    const int server = dial_();
    if (server < 0) {
      close(client);
      continue;
    }
    passers_.emplace_back(
        [this, client, server](const std::stop_token& passing) { pass(passing, client, server); });
  }
}

void Proxy::pass(const std::stop_token& stop, int client, int server) const {
  {
    const std::jthread to_server([&] {
      passOn(stop, client, server);
      shutdown(server, SHUT_RDWR);
    });
    pass_back_(stop, server, client);
    shutdown(client, SHUT_RDWR);
    shutdown(server, SHUT_RDWR);
  }
  close(client);
  close(server);
}

}  // namespace viewloom::test
