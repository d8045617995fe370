// SPDX-License-Identifier: Apache-2.0
#include "web/still.h"

#include <memory>

#include "absl/strings/str_cat.h"
#include "web/atlas_inbox.h"
#include "web/atlas_message.h"
#include "web/watch_request.h"

namespace viewloom {
namespace {

constexpr std::string_view kRoot = "/still/";
constexpr std::string_view kSuffixBegin = "_qs";
constexpr std::string_view kExtension = ".jpg";

// A still's path taken apart: /still/STREAM/PRESET or /still/STREAM_qs8x6a0.75.jpg.
struct StillName {
  QueryParameters parameters;  // of the URL and of its path
  std::string suffix;          // empty in the first form
};

// "_qs8x6a0.75" → columns, rows, aspect; whether they are numbers is for others to check.
bool readSuffix(std::string_view suffix, QueryParameters& parameters) {
  const size_t x = suffix.find('x', kSuffixBegin.size());
  const size_t a = suffix.find('a', kSuffixBegin.size());
  if (x == std::string_view::npos || a == std::string_view::npos || a < x) return false;
  parameters.emplace("columns", suffix.substr(kSuffixBegin.size(), x - kSuffixBegin.size()));
  parameters.emplace("rows", suffix.substr(x + 1, a - x - 1));
  parameters.emplace("aspect", suffix.substr(a + 1));
  return true;
}

absl::StatusOr<StillName> parseStillName(const Url& url) {
  std::string_view rest = std::string_view(url.path).substr(kRoot.size());
  StillName name{.parameters = url.parameters, .suffix = ""};
  const size_t slash = rest.find('/');
  const size_t suffix = rest.rfind(kSuffixBegin);
  if (slash != std::string_view::npos) {
    name.parameters["preset"] = rest.substr(slash + 1);
    name.parameters["stream"] = rest.substr(0, slash);
    return name;
  }
  if (suffix != std::string_view::npos && rest.ends_with(kExtension)) {
    name.suffix = rest.substr(suffix, rest.size() - suffix - kExtension.size());
    name.parameters["stream"] = rest.substr(0, suffix);
    if (name.parameters.contains("preset")) return name;
    if (readSuffix(name.suffix, name.parameters)) return name;
  }
  return fieldError(absl::StatusCode::kNotFound, "url",
                    "accepted are /still/STREAM/PRESET and /still/STREAM_qs8x6a0.75.jpg");
}

HttpReply stillReply(const EncodedAtlas& atlas) {
  HttpReply reply;
  reply.type = "image/jpeg";
  reply.headers = {{"Cache-Control", "no-store"},
                   {"Viewloom-Sequence", std::to_string(atlas.sequence)},
                   {"Viewloom-Frame-Number", std::to_string(atlas.frame_number)}};
  reply.shared = jpegBands(atlas);
  return reply;
}

net::awaitable<HttpReply> takeAtlas(WebContext& context, WatchRequest request) {
  const auto executor = co_await net::this_coro::executor;
  const auto deadline =
      std::make_shared<net::steady_timer>(executor, context.options.still_timeout);
  const auto inbox = std::make_shared<AtlasInbox>(
      context.clock, context.metrics.replaced[HandOver::kWeb],
      [executor, deadline] { net::post(executor, [deadline] { deadline->cancel(); }); });
  const auto subscription =
      context.broadcaster.subscribe(request.stream, request.display, request.encoding, inbox);
  if (!subscription.ok()) co_return errorReply(subscription.status());
  for (;;) {
    if (const auto arrival = inbox->take()) co_return stillReply(*arrival->atlas);
    if (const auto ended = inbox->ended()) {
      co_return errorReply(ended->ok() ? absl::UnavailableError("the server drains") : *ended);
    }
    ErrorCode interrupted;
    co_await deadline->async_wait(into(interrupted));
    if (!interrupted) break;
  }
  co_return errorReply(fieldError(
      absl::StatusCode::kDeadlineExceeded, "stream",
      absl::StrCat("\"", request.stream, "\" gave no atlas within ",
                   context.options.still_timeout.count(), " ms; does its publisher send frames?")));
}

}  // namespace

net::awaitable<HttpReply> answerStill(WebContext& context, Url url) {
  const absl::StatusOr<StillName> name = parseStillName(url);
  if (!name.ok()) co_return errorReply(name.status());
  const absl::StatusOr<WatchRequest> request = parseWatchRequest(name->parameters, context.streams);
  if (!request.ok()) co_return errorReply(request.status());
  const absl::StatusOr<std::string> suffix = quiltSuffix(request->display);
  if (!suffix.ok()) co_return errorReply(suffix.status());
  if (*suffix != name->suffix) {
    QueryParameters parameters = name->parameters;
    parameters.erase("stream");
    const std::string query = queryString(parameters);
    co_return redirectReply(absl::StrCat(std::string(kRoot), request->stream, *suffix, ".jpg",
                                         query.empty() ? "" : "?", query));
  }
  co_return co_await takeAtlas(context, *request);
}

}  // namespace viewloom
