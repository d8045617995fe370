// SPDX-License-Identifier: Apache-2.0
#include "web/still.h"

#include <memory>

#include <nlohmann/json.hpp>

#include "base/str_cat.h"
#include "web/admission.h"
#include "web/atlas_inbox.h"
#include "web/atlas_message.h"
#include "web/catalog_json.h"
#include "web/http_reply.h"
#include "web/quilt_address.h"

namespace viewloom {
namespace {

HttpReply jpegReply(const EncodedAtlas& atlas) {
  HttpReply reply;
  reply.type = "image/jpeg";
  reply.headers = {{"Cache-Control", "no-store"},
                   {"Viewloom-Sequence", std::to_string(atlas.sequence)},
                   {"Viewloom-Frame-Number", std::to_string(atlas.frame_number)}};
  reply.shared = colorBands(atlas);
  return reply;
}

HttpReply stillReply(const EncodedAtlas& atlas, const QuiltAddress& address) {
  HttpReply reply = address.extension == kLayoutExtension ? jsonReply(layoutJson(*atlas.layout))
                                                          : jpegReply(atlas);
  reply.headers.emplace_back("Content-Disposition", contentDisposition(address.file_name));
  return reply;
}

net::awaitable<HttpReply> takeAtlas(WebContext& context, QuiltAddress address, Caller caller,
                                    std::string identity) {
  const WatchRequest& request = address.request;
  absl::StatusOr<QuotaPartPtr> quota = holdDisplay(context, caller, request);
  if (!quota.ok()) co_return errorReply(quota.status());
  const auto executor = co_await net::this_coro::executor;
  const auto deadline =
      std::make_shared<net::steady_timer>(executor, context.options.still_timeout);
  const auto inbox = std::make_shared<AtlasInbox>(
      context.clock, context.metrics.replaced[HandOver::kWeb],
      [executor, deadline] { net::post(executor, [deadline] { deadline->cancel(); }); },
      std::move(identity), *std::move(quota));
  const auto subscription =
      context.broadcaster.subscribe(request.stream, request.display, request.encoding, inbox);
  if (!subscription.ok()) co_return errorReply(subscription.status());
  for (;;) {
    if (const auto arrival = inbox->take()) {
      HttpReply reply = stillReply(*arrival->atlas, address);
      caller.noteBytes(bodyBytes(reply));
      co_return reply;
    }
    if (const auto ended = inbox->ended()) {
      co_return errorReply(
          ended->ok() ? absl::UnavailableError("the server is shutting down; try again later")
                      : *ended);
    }
    ErrorCode interrupted;
    co_await deadline->async_wait(into(interrupted));
    if (!interrupted) break;
  }
  co_return errorReply(fieldError(
      absl::StatusCode::kDeadlineExceeded, "stream",
      strCat("no picture of stream \"", request.stream, "\" was ready within ",
             context.options.still_timeout.count(), " ms; check that its publisher sends frames")));
}

}  // namespace

net::awaitable<HttpReply> answerStill(WebContext& context, HttpRequest request, Url url) {
  absl::StatusOr<AdmittedPicture> picture =
      admitPicture(context, request, std::move(url), stillForm());
  if (!picture.ok()) co_return errorReply(picture.status());
  QuiltAddress& address = picture->address;
  if (!address.redirect.empty()) co_return redirectReply(address.redirect);
  std::string identity = picture->caller.shareName(request.client_host);
  co_return co_await takeAtlas(context, std::move(address), std::move(picture->caller),
                               std::move(identity));
}

}  // namespace viewloom
