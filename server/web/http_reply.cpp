// SPDX-License-Identifier: Apache-2.0
#include "web/http_reply.h"

#include <nlohmann/json.hpp>

#include "absl/strings/ascii.h"
#include "base/str_cat.h"
#include "web/url.h"

namespace viewloom {
namespace {

constexpr std::string_view kPlainMarks = "-._ ()+,=@";

// Hidden files begin with a dot, and so do the names of folders above.
std::string plainName(std::string_view file_name) {
  const bool needs_front = file_name.empty() || file_name.front() == '.';
  std::string plain = needs_front ? "_" : "";
  for (const char character : file_name) {
    const bool is_plain = absl::ascii_isalnum(static_cast<unsigned char>(character)) ||
                          kPlainMarks.find(character) != std::string_view::npos;
    plain.push_back(is_plain ? character : '_');
  }
  return plain;
}

// The library throws where a text is no UTF-8, unless it may replace it.
std::string textOf(const nlohmann::json& value) {
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

HttpReply replyWithJson(std::string text) {
  HttpReply reply;
  reply.type = "application/json";
  reply.headers = {{"Cache-Control", "no-store"}};
  reply.text = std::move(text);
  return reply;
}

}  // namespace

size_t bodyBytes(const HttpReply& reply) {
  size_t bytes = reply.text.size() + reply.fixed.size();
  for (const SharedBytes& part : reply.shared) bytes += part->size();
  return bytes;
}

unsigned httpStatusOf(absl::StatusCode code) {
  switch (code) {
    case absl::StatusCode::kOk:
      return 200;
    case absl::StatusCode::kInvalidArgument:
    case absl::StatusCode::kOutOfRange:
      return 400;
    case absl::StatusCode::kUnauthenticated:
      return 401;
    case absl::StatusCode::kPermissionDenied:
      return 403;
    case absl::StatusCode::kNotFound:
      return 404;
    case absl::StatusCode::kAlreadyExists:
    case absl::StatusCode::kAborted:
    case absl::StatusCode::kFailedPrecondition:
      return 409;
    case absl::StatusCode::kUnimplemented:
      return 501;
    case absl::StatusCode::kUnavailable:
    case absl::StatusCode::kResourceExhausted:
      return 503;
    case absl::StatusCode::kDeadlineExceeded:
      return 504;
    default:
      return 500;
  }
}

std::string errorJson(const absl::Status& status) {
  const nlohmann::json error = {{"error",
                                 {{"code", absl::StatusCodeToString(status.code())},
                                  {"field", fieldOf(status)},
                                  {"message", std::string(status.message())}}}};
  return textOf(error);
}

HttpReply jsonReply(const nlohmann::json& value) {
  return replyWithJson(textOf(value));
}

HttpReply errorReply(const absl::Status& status) {
  return errorReply(httpStatusOf(status.code()), status);
}

HttpReply errorReply(unsigned http_status, const absl::Status& status) {
  HttpReply reply = replyWithJson(errorJson(status) + "\n");
  reply.status = http_status;
  if (http_status == 401) reply.headers.emplace_back("WWW-Authenticate", "Bearer");
  return reply;
}

HttpReply redirectReply(std::string location) {
  HttpReply reply;
  reply.status = 302;
  reply.type = "text/plain; charset=utf-8";
  reply.text = "see " + location + "\n";
  reply.headers = {{"Location", std::move(location)}, {"Cache-Control", "no-store"}};
  return reply;
}

std::string contentDisposition(std::string_view file_name) {
  const std::string plain = plainName(file_name);
  std::string value = strCat("inline; filename=\"", plain, "\"");
  if (plain != file_name) value += strCat("; filename*=UTF-8''", percentEncoded(file_name));
  return value;
}

}  // namespace viewloom
