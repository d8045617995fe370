// SPDX-License-Identifier: Apache-2.0
// A proxy before a server of TCP that sends no faster than a line would.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "support/proxy.h"

namespace viewloom::test {

// Passes the bytes of each connection both ways; those of the server at the speed of the line,
// which may change at any time. It holds few bytes, as lines with short queues do. Thread-safety:
// all methods may be called from any thread.
class SlowLine {
 public:
  // `server_address`: "127.0.0.1:PORT".
  SlowLine(const std::string& server_address, double mbit_per_second);

  std::string address() const;
  void setSpeed(double mbit_per_second) { bytes_per_ms_ = mbit_per_second * 1e6 / 8 / 1e3; }

 private:
  void passBack(const std::stop_token& stop, int server, int client) const;

  std::atomic<double> bytes_per_ms_ = 0;
  const Proxy proxy_;  // last: it uses the rest
};

}  // namespace viewloom::test
