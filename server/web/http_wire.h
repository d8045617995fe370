// SPDX-License-Identifier: Apache-2.0
// Replies as they go over the wire.
#pragma once

#include <optional>
#include <vector>

#include "metrics/metrics.h"
#include "web/asio.h"
#include "web/http_reply.h"

namespace viewloom {

// The reply to bytes that are no request; none when the other side just went.
std::optional<HttpReply> replyToBroken(const ErrorCode& error);

// How metrics count a reply of that status.
HttpAnswer answerKind(unsigned status);

// The bytes of the body, as long as the reply lives.
std::vector<net::const_buffer> bodyOf(const HttpReply& reply);

// The head, without the length of the body and without the end of the connection.
http::response<http::empty_body> headOf(const HttpReply& reply);

}  // namespace viewloom
