// SPDX-License-Identifier: Apache-2.0
// A request to the web server: what its first line and its headers say.
#pragma once

#include <string>

#include "web/host_policy.h"

namespace viewloom {

struct HttpRequest {
  std::string method;
  std::string target;
  std::string peer;  // address of the client
  // The same, or the subject of the client's certificate: whose share the request takes.
  std::string client_host;
  // Headers; empty when not given.
  std::string host;
  std::string if_none_match;
  std::string authorization;
  std::string cookie;
  std::string websocket_protocols;
  PageHeaders page{};
  bool is_encrypted = false;  // by this server, or by a proxy before it
  bool upgrade = false;       // to a WebSocket
};

}  // namespace viewloom
