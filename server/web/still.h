// SPDX-License-Identifier: Apache-2.0
// One atlas of a stream as one JPEG, at a URL that says how the views lie in it.
#pragma once

#include <string>

#include "web/asio.h"
#include "web/http_reply.h"
#include "web/http_request.h"
#include "web/url.h"
#include "web/web_context.h"

namespace viewloom {

// Answers /still/STREAM_qs8x6a0.75.jpg and /still/STREAM/PRESET (see quilt_address.h); with .json
// the layout of that JPEG. The reply names the file to save it as. Runs on the caller's strand;
// waits for the atlas at most as long as options.still_timeout.
net::awaitable<HttpReply> answerStill(WebContext& context, HttpRequest request, Url url);

}  // namespace viewloom
