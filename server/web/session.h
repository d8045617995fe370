// SPDX-License-Identifier: Apache-2.0
// Access tokens of web clients: where they come from, and the cookie of the page.
#pragma once

#include <string>
#include <string_view>

#include "web/http_reply.h"
#include "web/http_request.h"
#include "web/web_context.h"

namespace viewloom {

// The protocol that a WebSocket of the page speaks. Beside it a client may offer "bearer.TOKEN".
inline constexpr std::string_view kWebSocketProtocol = "viewloom";

// The token of the Authorization header, else of a WebSocket's protocols, else of the cookie; ""
// without any. Addresses never hold a token: they end up in logs, histories and Referer headers.
std::string tokenOf(const HttpRequest& request);
// Whether a WebSocket offers kWebSocketProtocol, which the server then has to choose.
bool offersProtocol(const HttpRequest& request);

// Answers /api/session. GET says who the client is; POST takes the token of the Authorization
// header into a cookie that scripts cannot read; DELETE takes the cookie away.
HttpReply answerSession(const WebContext& context, const HttpRequest& request);

}  // namespace viewloom
