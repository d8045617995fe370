// SPDX-License-Identifier: Apache-2.0
// Waits for sockets and writes to them, for the proxies of tests.
#pragma once

#include <poll.h>
#include <sys/socket.h>

#include <cstddef>
#include <cstdint>

namespace viewloom::test {

// A proxy sees within this time that it shall stop.
inline constexpr int kProxyTick_ms = 10;

// Whether bytes, a connection or the end come within the time.
inline bool isReadable(int socket, int timeout_ms) {
  pollfd waiting{.fd = socket, .events = POLLIN, .revents = 0};
  return poll(&waiting, 1, timeout_ms) > 0;
}

// False when the other side is gone.
inline bool sendAll(int socket, const uint8_t* bytes, size_t count) {
  while (count > 0) {
    const ssize_t sent = send(socket, bytes, count, MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes += sent;
    count -= size_t(sent);
  }
  return true;
}

}  // namespace viewloom::test
