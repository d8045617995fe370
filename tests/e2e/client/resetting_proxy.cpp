// SPDX-License-Identifier: Apache-2.0
#include "e2e/client/resetting_proxy.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>

#include "support/socket_bytes.h"

namespace viewloom {
namespace {

using test::isReadable;
using test::sendAll;

constexpr size_t kFrameHeadBytes = 9;
constexpr uint8_t kFirstCall = 1;  // the stream that a client opens first

sockaddr_un socketAddress(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof(address.sun_path) - 1);
  return address;
}

int listenAt(const std::string& path) {
  const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
  const sockaddr_un address = socketAddress(path);
  if (bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
      listen(listener, 8) != 0) {
    throw std::runtime_error("the proxy cannot listen at " + path);
  }
  return listener;
}

int dial(const std::string& path) {
  const int server = socket(AF_UNIX, SOCK_STREAM, 0);
  const sockaddr_un address = socketAddress(path);
  if (connect(server, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) {
    return server;
  }
  close(server);
  return -1;
}

bool sendReset(int socket, uint32_t code) {
  constexpr uint8_t kLength = 4, kRstStream = 3;
  const std::array<uint8_t, kFrameHeadBytes + kLength> frame{0,
                                                             0,
                                                             kLength,
                                                             kRstStream,
                                                             0,
                                                             0,
                                                             0,
                                                             0,
                                                             kFirstCall,
                                                             uint8_t(code >> 24),
                                                             uint8_t(code >> 16),
                                                             uint8_t(code >> 8),
                                                             uint8_t(code)};
  return sendAll(socket, frame.data(), frame.size());
}

// Knows where frames of a server end: each says how long it is.
class FrameEnds {
 public:
  // Bytes that may be taken without going past the end of what is being read.
  size_t left() const {
    return head_count_ < kFrameHeadBytes ? kFrameHeadBytes - head_count_ : body_;
  }
  void took(const uint8_t* bytes, size_t count) {
    if (head_count_ == kFrameHeadBytes) {
      body_ -= count;
    } else {
      std::copy_n(bytes, count, head_.begin() + ptrdiff_t(head_count_));
      head_count_ += count;
      body_ = (size_t{head_[0]} << 16) | (size_t{head_[1]} << 8) | head_[2];
    }
    if (head_count_ == kFrameHeadBytes && body_ == 0) head_count_ = 0;
  }
  bool isBetween() const { return head_count_ == 0; }

 private:
  std::array<uint8_t, kFrameHeadBytes> head_{};
  size_t head_count_ = 0;
  size_t body_ = 0;
};

}  // namespace

ResettingProxy::ResettingProxy(const std::string& server_address)
    : server_path_(server_address.substr(std::strlen("unix:"))),
      path_(server_path_ + ".proxy"),
      proxy_(
          listenAt(path_), [this] { return dial(server_path_); },
          [this](const std::stop_token& stop, int server, int client) {
            passBack(stop, server, client);
          }) {}

ResettingProxy::~ResettingProxy() {
  unlink(path_.c_str());
}

void ResettingProxy::resetStream(uint32_t error_code) {
  reset_code_ = error_code;
}

void ResettingProxy::passBack(const std::stop_token& stop, int server, int client) {
  std::vector<uint8_t> bytes(1 << 16);
  FrameEnds ends;
  while (!stop.stop_requested()) {
    if (ends.isBetween()) {
      const int64_t code = reset_code_.exchange(-1);
      if (code >= 0 && !sendReset(client, uint32_t(code))) return;
    }
    if (!isReadable(server, test::kProxyTick_ms)) continue;
    const ssize_t count = recv(server, bytes.data(), std::min(bytes.size(), ends.left()), 0);
    if (count <= 0 || !sendAll(client, bytes.data(), size_t(count))) return;
    ends.took(bytes.data(), size_t(count));
  }
}

}  // namespace viewloom
