// SPDX-License-Identifier: Apache-2.0
#include "web/admission.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include <nlohmann/json.hpp>

#include "absl/strings/ascii.h"
#include "access/utc_time.h"
#include "admission/display_price.h"
#include "base/printable.h"
#include "base/str_cat.h"
#include "display/tracked_eyes.h"
#include "web/qr_code.h"
#include "web/session.h"

namespace viewloom {
namespace {

constexpr const char* kLinkParameter = "link";
constexpr int64_t kUsualLinkSeconds = 300;
constexpr int kQrBytesMax = 2953;  // of version 40, level L

// A link to a still does not open a stream, which goes on for as long as its token, and a link to
// motion JPEG opens no video, which costs more.
LinkTarget targetOf(const QuiltAddress& address, const QuiltAddressForm& form) {
  const WatchRequest& request = address.request;
  const bool is_movie = address.extension == kMovieExtension;
  return {.stream = request.stream,
          .display = strCat(form.root, is_movie ? kMovieExtension : "", "\n",
                            displayKey(request.display), "\n", encodingKey(request.encoding))};
}

// Takes the parameter out; "" if there is none.
std::string takeParameter(QueryParameters& parameters, const char* name) {
  const auto found = parameters.find(name);
  if (found == parameters.end()) return "";
  std::string value = std::move(found->second);
  parameters.erase(found);
  return value;
}

std::string withParameter(const std::string& address, std::string_view name,
                          std::string_view value) {
  const bool is_first = address.find('?') == std::string::npos;
  return strCat(address, is_first ? "?" : "&", name, "=", percentEncoded(value));
}

absl::Status admitStream(const Caller& caller, const std::string& stream,
                         const StreamDirectory& streams) {
  VIEWLOOM_RETURN_IF_ERROR(caller.mayUse(stream));
  return checkStream(stream, caller, streams);
}

absl::StatusOr<int64_t> linkSeconds(const QueryParameters& parameters) {
  const auto found = parameters.find("seconds");
  if (found == parameters.end()) return kUsualLinkSeconds;
  const std::string& text = found->second;
  int64_t seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error == std::errc() && end == text.data() + text.size()) return seconds;
  return invalidField("seconds", "is no whole number; accepted is a number of seconds");
}

// The form of addresses to which a path belongs.
absl::StatusOr<QuiltAddressForm> formOf(const std::string& path) {
  for (const QuiltAddressForm& form : {stillForm(), streamForm()}) {
    if (path.starts_with(form.root)) return form;
  }
  return invalidField("target",
                      "is no address of a picture; accepted are /still/... and /stream/...");
}

bool isPath(std::string_view text) {
  return std::ranges::all_of(text, [](char c) {
    return absl::ascii_isalnum(static_cast<unsigned char>(c)) ||
           std::string_view("/._~-%").find(c) != std::string_view::npos;
  });
}

// The address of this server's page, as the client reaches it: a proxy may serve it below a path.
// A code leads to this server only.
absl::StatusOr<std::string> pageOf(const HttpRequest& request, const QueryParameters& parameters) {
  const auto found = parameters.find("page");
  if (found == parameters.end()) {
    return strCat(request.is_encrypted ? "https://" : "http://", request.host, "/");
  }
  const std::string& page = found->second;
  for (const char* scheme : {"http://", "https://"}) {
    const std::string begin = strCat(scheme, request.host, "/");
    const bool is_below = page.starts_with(begin) && page.ends_with('/');
    if (is_below && isPath(std::string_view(page).substr(begin.size()))) return page;
  }
  return invalidField("page", strCat("got \"", quotable(page),
                                     "\"; accepted is the address of this "
                                     "server's page, such as https://",
                                     request.host, "/"));
}

// The address as a link holds it: without what browsers keep to themselves, and in plain ASCII.
std::string linkable(std::string_view address) {
  std::string plain;
  for (const char& character : address.substr(0, address.find('#'))) {
    const bool is_plain = character > ' ' && character <= '~';
    plain += is_plain ? std::string(1, character) : percentEncoded({&character, 1});
  }
  return plain;
}

struct MadeLink {
  std::string url;
  int64_t expires_s = 0;
};

absl::StatusOr<MadeLink> makeLink(const WebContext& context, const HttpRequest& request,
                                  std::string_view operation, const QueryParameters& parameters) {
  const absl::StatusOr<Caller> caller = admitRequest(context, request, operation);
  VIEWLOOM_RETURN_IF_ERROR(caller.status());
  const auto target = parameters.find("target");
  if (target == parameters.end()) {
    return invalidField("target", "is missing; accepted are /still/... and /stream/...");
  }
  const absl::StatusOr<Url> url = parseUrl(target->second);
  VIEWLOOM_RETURN_IF_ERROR(url.status());
  const absl::StatusOr<QuiltAddressForm> form = formOf(url->path);
  VIEWLOOM_RETURN_IF_ERROR(form.status());
  const absl::StatusOr<QuiltAddress> address = parseQuiltAddress(*url, *form);
  VIEWLOOM_RETURN_IF_ERROR(address.status());
  VIEWLOOM_RETURN_IF_ERROR(admitStream(*caller, address->request.stream, context.streams));
  const absl::StatusOr<int64_t> seconds = linkSeconds(parameters);
  VIEWLOOM_RETURN_IF_ERROR(seconds.status());
  const auto link = context.access.sign(*caller, targetOf(*address, *form), *seconds);
  VIEWLOOM_RETURN_IF_ERROR(link.status());
  const std::string& plain = address->redirect.empty() ? target->second : address->redirect;
  return MadeLink{.url = withParameter(linkable(plain), kLinkParameter, link->signature),
                  .expires_s = link->expires_s};
}

}  // namespace

absl::StatusOr<Caller> admitRequest(const WebContext& context, const HttpRequest& request,
                                    std::string_view operation) {
  return context.access.admit(operation, request.peer, tokenOf(request));
}

absl::StatusOr<Caller> admitViewer(const WebContext& context, const HttpRequest& request,
                                   const Url& url) {
  absl::StatusOr<Caller> caller = admitRequest(context, request, kWebSocket);
  VIEWLOOM_RETURN_IF_ERROR(caller.status());
  const absl::StatusOr<WatchRequest> watched = makeWatchRequest(url.parameters);
  VIEWLOOM_RETURN_IF_ERROR(watched.status());
  VIEWLOOM_RETURN_IF_ERROR(admitStream(*caller, watched->stream, context.streams));
  return caller;
}

absl::StatusOr<AdmittedPicture> admitPicture(const WebContext& context, const HttpRequest& request,
                                             Url url, const QuiltAddressForm& form) {
  const std::string link = takeParameter(url.parameters, kLinkParameter);
  absl::StatusOr<Caller> caller = absl::UnauthenticatedError("no link came");
  if (link.empty()) {
    caller = admitRequest(context, request, form.root);
    VIEWLOOM_RETURN_IF_ERROR(caller.status());
  }
  absl::StatusOr<QuiltAddress> address = parseQuiltAddress(url, form);
  VIEWLOOM_RETURN_IF_ERROR(address.status());
  if (!link.empty()) {
    caller = context.access.admitLink(form.root, request.peer, link, targetOf(*address, form));
    VIEWLOOM_RETURN_IF_ERROR(caller.status());
    if (!address->redirect.empty()) {
      address->redirect = withParameter(address->redirect, kLinkParameter, link);
    }
  }
  VIEWLOOM_RETURN_IF_ERROR(admitStream(*caller, address->request.stream, context.streams));
  return AdmittedPicture{.caller = *std::move(caller), .address = *std::move(address)};
}

absl::StatusOr<QuotaPartPtr> holdDisplay(const WebContext& context, const Caller& caller,
                                         const WatchRequest& request, const QuotaPart* replaced,
                                         const void* viewer) {
  const auto& [stream, display, encoding] = request;
  std::string key = strCat(stream, " ", displayKey(display), encodingKey(encoding));
  if (isTracked(display)) key += strCat("of ", absl::Hex(reinterpret_cast<uintptr_t>(viewer)));
  absl::StatusOr<QuotaPartPtr> held =
      caller.holdDisplay({.key = std::move(key),
                          .pixels = atlasPixels(display),
                          .rate_hz = pictureRate(display, context.streams.rateHz(stream))},
                         replaced);
  VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(held.status(), "display"));
  return held;
}

HttpReply answerLink(const WebContext& context, const HttpRequest& request, const Url& url) {
  const absl::StatusOr<MadeLink> link = makeLink(context, request, kApiLink, url.parameters);
  if (!link.ok()) return errorReply(link.status());
  return jsonReply({{"url", link->url}, {"expires", utcText(link->expires_s)}});
}

HttpReply answerQr(const WebContext& context, const HttpRequest& request, const Url& url) {
  const absl::StatusOr<std::string> page = pageOf(request, url.parameters);
  if (!page.ok()) return errorReply(page.status());
  const absl::StatusOr<MadeLink> link = makeLink(context, request, kApiQr, url.parameters);
  if (!link.ok()) return errorReply(link.status());
  const std::string address = strCat(*page, link->url.substr(1));
  HttpReply reply;
  reply.type = "image/svg+xml";
  reply.headers = {{"Cache-Control", "no-store"}};
  reply.text = qrPicture(address, utcText(link->expires_s));
  if (!reply.text.empty()) return reply;
  return errorReply(invalidField(
      "target", strCat("the link has ", address.size(), " bytes; a QR code holds up to ",
                       kQrBytesMax, ". Choose a preset instead of a display of your own")));
}

}  // namespace viewloom
