// SPDX-License-Identifier: Apache-2.0
// Reach of the server: this machine alone, those who are let in, or anybody.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace viewloom {

struct Exposure {
  std::vector<std::string> addresses;  // all that it listens on: HOST:PORT or unix:PATH
  bool has_tls = false;
  bool has_access_control = false;  // tokens, or required certificates of clients
  bool is_open_wanted = false;      // --open
};

enum class ServerReach : uint8_t {
  kMachine,    // loopback and Unix sockets
  kProtected,  // beyond the machine, encrypted, for those who are let in
  kOpen        // beyond the machine, for anybody on the way or at the other end
};

ServerReach reachOf(const Exposure& exposure);

// Why the server must not listen so: one sentence, with the ways out. Nothing when it may.
std::optional<std::string> refusalToListen(const Exposure& exposure);

}  // namespace viewloom
