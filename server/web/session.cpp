// SPDX-License-Identifier: Apache-2.0
#include "web/session.h"

#include <algorithm>
#include <vector>

#include <nlohmann/json.hpp>

#include "absl/strings/ascii.h"
#include "absl/strings/str_split.h"
#include "access/bearer.h"
#include "access/utc_time.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr std::string_view kBearerProtocol = "bearer.";
constexpr std::string_view kCookieBegin = "viewloom_token=";
// Browsers drop longer cookies without a word.
constexpr size_t kCookieBytesMax = 4000;

// The parts of a list, without the blanks around them.
std::vector<std::string> listOf(const std::string& text, char separator) {
  std::vector<std::string> parts = absl::StrSplit(text, separator);
  for (std::string& part : parts) absl::StripAsciiWhitespace(&part);
  return parts;
}

// The rest of the first part that begins with `begin`.
std::string valueOf(const std::string& list, char separator, std::string_view begin) {
  for (const std::string& part : listOf(list, separator)) {
    if (part.starts_with(begin)) return part.substr(begin.size());
  }
  return "";
}

// `value` is a token that was accepted: it has no characters that a cookie may not have.
std::string cookieOf(const HttpRequest& request, std::string_view value, std::string_view more) {
  return strCat(kCookieBegin, value, "; Path=/; HttpOnly; SameSite=Strict",
                request.is_encrypted ? "; Secure" : "", more);
}

HttpReply identityReply(const AccessControl& access, const Identity& identity) {
  nlohmann::json object = {{"needs_token", access.isOn()}};
  if (identity.proof != Proof::kNothing) {
    object["id"] = identity.id;
    object["streams"] = identity.rights.streams.texts();
    for (const Role role : identity.rights.roles) object["roles"].push_back(wordOf(role));
    if (identity.expires_s) object["expires"] = utcText(*identity.expires_s);
  }
  return jsonReply(object);
}

}  // namespace

std::string tokenOf(const HttpRequest& request) {
  if (!request.authorization.empty()) return std::string(bearerToken(request.authorization));
  const std::string offered = valueOf(request.websocket_protocols, ',', kBearerProtocol);
  return offered.empty() ? valueOf(request.cookie, ';', kCookieBegin) : offered;
}

bool offersProtocol(const HttpRequest& request) {
  const std::vector<std::string> offered = listOf(request.websocket_protocols, ',');
  return std::ranges::find(offered, kWebSocketProtocol) != offered.end();
}

HttpReply answerSession(const WebContext& context, const HttpRequest& request) {
  if (request.method == "DELETE") {
    HttpReply reply = jsonReply(nlohmann::json::object());
    reply.headers.emplace_back("Set-Cookie", cookieOf(request, "", "; Max-Age=0"));
    return reply;
  }
  const bool signs_in = request.method == "POST";
  const std::string token =
      signs_in ? std::string(bearerToken(request.authorization)) : tokenOf(request);
  const absl::StatusOr<Caller> caller = context.access.admit(kApiSession, request.peer, token);
  if (!caller.ok()) return errorReply(caller.status());
  HttpReply reply = identityReply(context.access, caller->identity());
  if (!signs_in || caller->identity().proof == Proof::kNothing) return reply;
  if (token.size() > kCookieBytesMax) {
    return errorReply(fieldError(
        absl::StatusCode::kInvalidArgument, "authorization",
        strCat("the token has ", token.size(), " bytes; a page accepts up to ", kCookieBytesMax)));
  }
  reply.headers.emplace_back("Set-Cookie", cookieOf(request, token, ""));
  return reply;
}

}  // namespace viewloom
