// SPDX-License-Identifier: Apache-2.0
// Which path gives what.
#pragma once

#include <optional>
#include <string_view>

#include "web/asio.h"
#include "web/http_reply.h"
#include "web/http_request.h"
#include "web/web_context.h"

namespace viewloom {

// Whether the target is one of those that watch over the server: /healthz, /metrics.
bool isStatusTarget(std::string_view target);

// Whether host, page and method are accepted; the refusal otherwise.
std::optional<HttpReply> refusal(const WebContext& context, const HttpRequest& request);

// Sends a request that came without TLS to the same address with it. The client concatenates
// addresses, too: a target that is no path would lead to another host, and is refused.
HttpReply redirectToTls(const HttpRequest& request);

// Answers everything but WebSockets. Runs on the caller's strand.
net::awaitable<HttpReply> answer(WebContext& context, HttpRequest request);

}  // namespace viewloom
