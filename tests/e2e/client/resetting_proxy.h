// SPDX-License-Identifier: Apache-2.0
// A proxy between a gRPC client and its server that breaks off one call, and keeps the connection.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "support/proxy.h"

namespace viewloom {

// Passes the bytes of each connection both ways. Between two frames of HTTP/2 it slips in a
// RST_STREAM. Thread-safety: all methods may be called from any thread.
class ResettingProxy {
 public:
  // `server_address`: "unix:PATH".
  explicit ResettingProxy(const std::string& server_address);
  ~ResettingProxy();
  ResettingProxy(const ResettingProxy&) = delete;
  ResettingProxy& operator=(const ResettingProxy&) = delete;

  std::string address() const { return "unix:" + path_; }
  // Resets the first call of one connection, with an error code of HTTP/2.
  void resetStream(uint32_t error_code);

 private:
  void passBack(const std::stop_token& stop, int server, int client);

  const std::string server_path_;
  const std::string path_;
  std::atomic<int64_t> reset_code_ = -1;  // to send; -1 = none
  const test::Proxy proxy_;               // last: it uses the rest
};

}  // namespace viewloom
