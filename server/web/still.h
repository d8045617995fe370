// SPDX-License-Identifier: Apache-2.0
// One atlas of a stream as one JPEG, at a URL that says how the views lie in it.
#pragma once

#include "web/asio.h"
#include "web/http_reply.h"
#include "web/url.h"
#include "web/web_context.h"

namespace viewloom {

// Answers /still/STREAM_qs8x6a0.75.jpg with the parameters of parseWatchRequest. Where no parameter
// gives them, columns, rows and aspect are those of the suffix. /still/STREAM/PRESET, and a suffix
// that does not fit the parameters, redirect to the URL that does. Runs on the caller's strand;
// waits for the atlas at most as long as options.still_timeout.
net::awaitable<HttpReply> answerStill(WebContext& context, Url url);

}  // namespace viewloom
