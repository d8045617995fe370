// SPDX-License-Identifier: Apache-2.0
// Replies that go on as long as a player reads them: motion JPEG and live MP4.
#pragma once

#include <memory>
#include <string>

#include "web/asio.h"
#include "web/http_reply.h"
#include "web/http_request.h"
#include "web/live_stream.h"
#include "web/url.h"
#include "web/web_context.h"

namespace viewloom {

// Answers /stream/STREAM_qs8x6a0.75.mjpg, .mp4 and /stream/STREAM/PRESET (see quilt_address.h): a
// reply whose `live` is set, or the error or redirect. Headers of a video say how large it is, and
// whether it is scaled.
HttpReply answerStream(const WebContext& context, const HttpRequest& request, const Url& url);

// The player of such a reply. `identity`: see Subscriber.
std::shared_ptr<LiveStream> makeLiveStream(WebContext& context, const HttpReply::Live& live,
                                           net::any_io_executor strand, std::string identity);

}  // namespace viewloom
