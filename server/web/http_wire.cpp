// SPDX-License-Identifier: Apache-2.0
#include "web/http_wire.h"

#include "base/str_cat.h"
#include "web/web_context.h"

namespace viewloom {
namespace {

constexpr unsigned kHttpVersion11 = 11;

}  // namespace

std::optional<HttpReply> replyToBroken(const ErrorCode& error) {
  if (error == http::error::header_limit) {
    return errorReply(
        431,
        invalidField("header", strCat("the header of the request is too long; accepted is up to ",
                                      HttpOptions{}.header_bytes_max,
                                      " bytes. Send a long display over the WebSocket /ws, as "
                                      "a change")));
  }
  if (error == http::error::body_limit) {
    return errorReply(
        413, invalidField("body", "the request has a body; accepted is a request without one"));
  }
  const bool is_http = error.category() == make_error_code(http::error::bad_method).category();
  if (!is_http || error == http::error::end_of_stream) return std::nullopt;
  return errorReply(400, invalidField("request", "the request is not HTTP: " + error.message()));
}

HttpAnswer answerKind(unsigned status) {
  if (status >= 500) return HttpAnswer::kServerError;
  if (status >= 400) return HttpAnswer::kClientError;
  return status >= 300 ? HttpAnswer::kRedirect : HttpAnswer::kSuccess;
}

std::vector<net::const_buffer> bodyOf(const HttpReply& reply) {
  std::vector<net::const_buffer> body;
  body.push_back(net::buffer(reply.text));
  body.emplace_back(reply.fixed.data(), reply.fixed.size());
  for (const SharedBytes& bytes : reply.shared) body.push_back(net::buffer(*bytes));
  return body;
}

http::response<http::empty_body> headOf(const HttpReply& reply) {
  http::response<http::empty_body> head(http::int_to_status(reply.status), kHttpVersion11);
  head.set(http::field::server, "viewloom");
  head.set("X-Content-Type-Options", "nosniff");
  head.set("Cross-Origin-Resource-Policy", "same-origin");
  if (!reply.type.empty()) head.set(http::field::content_type, reply.type);
  for (const auto& [name, value] : reply.headers) head.set(name, value);
  return head;
}

}  // namespace viewloom
