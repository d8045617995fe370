// SPDX-License-Identifier: Apache-2.0
// A proxy in front of a server, for tests of what happens on the way.
#pragma once

#include <functional>
#include <thread>
#include <vector>

namespace viewloom::test {

// Passes the bytes of each connection both ways, until either side closes.
class Proxy {
 public:
  // Connects a socket to the server, -1 = there is none. Called on a thread of the proxy's own.
  using Dial = std::function<int()>;
  // Passes the bytes of the server to the client, until either side closes or the stop. Called on
  // a thread of each connection's own.
  using PassBack = std::function<void(const std::stop_token& stop, int server, int client)>;

  // Closes the listener at its end.
  Proxy(int listener, Dial dial, PassBack pass_back);
  ~Proxy();
  Proxy(const Proxy&) = delete;
  Proxy& operator=(const Proxy&) = delete;

  int listener() const { return listener_; }

 private:
  void accept(const std::stop_token& stop);
  void pass(const std::stop_token& stop, int client, int server) const;

  const int listener_;
  const Dial dial_;
  const PassBack pass_back_;
  std::vector<std::jthread> passers_;  // the acceptor's own
  std::jthread acceptor_;              // last: it uses the rest
};

}  // namespace viewloom::test
