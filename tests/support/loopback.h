// SPDX-License-Identifier: Apache-2.0
// Sockets of tests on loopback.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdint>
#include <stdexcept>
#include <string>

namespace viewloom::test {

// 127.0.0.1. `port`: 0 = any that is free, for bind().
inline sockaddr_in loopback(uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

// A socket that listens on a port that was free. Throws where it cannot.
inline int listenAnywhere() {
  constexpr int kWaitingMax = 16;
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in address = loopback(0);
  if (bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
      listen(listener, kWaitingMax) != 0) {
    throw std::runtime_error("a test cannot listen on loopback");
  }
  return listener;
}

// "127.0.0.1:PORT"
inline std::string addressOf(int listener) {
  sockaddr_in address{};
  socklen_t size = sizeof(address);
  getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
  return "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
}

inline uint16_t portIn(const std::string& address) {
  return uint16_t(std::stoi(address.substr(address.rfind(':') + 1)));
}

// Whether it was connected to the port of loopback.
inline bool connectTo(int socket, uint16_t port) {
  const sockaddr_in address = loopback(port);
  return connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
}

}  // namespace viewloom::test
