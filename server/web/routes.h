// SPDX-License-Identifier: Apache-2.0
// Which path gives what.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "web/asio.h"
#include "web/http_reply.h"
#include "web/web_context.h"

namespace viewloom {

struct HttpRequest {
  std::string method;
  std::string target;
  std::string host;  // headers; empty when not given
  std::string origin;
  std::string if_none_match;
  bool upgrade = false;  // to a WebSocket
};

inline constexpr std::string_view kWebSocketPath = "/ws";

// Whether host, origin and method are accepted; the refusal otherwise.
std::optional<HttpReply> refusal(const WebContext& context, const HttpRequest& request);

// Answers everything but WebSockets. Runs on the caller's strand.
net::awaitable<HttpReply> answer(WebContext& context, HttpRequest request);

}  // namespace viewloom
