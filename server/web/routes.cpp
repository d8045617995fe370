// SPDX-License-Identifier: Apache-2.0
#include "web/routes.h"

#include <algorithm>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "absl/strings/str_join.h"
#include "base/heap.h"
#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/str_cat.h"
#include "web/admission.h"
#include "web/catalog_json.h"
#include "web/live_answer.h"
#include "web/page_assets.h"
#include "web/session.h"
#include "web/still.h"

namespace viewloom {
namespace {

// Everything comes from the server itself; pictures are made from bytes the page received. The one
// exception: panel mode may ask Looking Glass Bridge on the viewer's own machine for a calibration
// (client/web/bridge_panels.js).
constexpr const char* kContentSecurityPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; "
    "connect-src 'self' http://localhost:33334; worker-src 'self'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors ";

// Pages of the allowed origins may show this one in a frame.
std::string contentSecurityPolicy(const HostPolicy& host_policy) {
  const std::string origins = absl::StrJoin(host_policy.allowedOrigins(), " ");
  return kContentSecurityPolicy + (origins.empty() ? "'none'" : origins);
}

HttpReply assetReply(const WebContext& context, const PageAsset& asset,
                     const HttpRequest& request) {
  HttpReply reply;
  reply.type = asset.type;
  reply.headers = {{"ETag", std::string(asset.etag)},
                   {"Cache-Control", "no-cache"},
                   {"Content-Security-Policy", contentSecurityPolicy(context.host_policy)},
                   {"Referrer-Policy", "no-referrer"}};
  if (request.if_none_match == asset.etag) {
    reply.status = 304;
  } else {
    reply.fixed = asset.bytes;
  }
  return reply;
}

HttpReply metricsReply(const WebContext& context) {
  size_t live_count = 0;
  for (const StreamEntry& entry : context.streams.list()) live_count += entry.live;
  context.metrics.streams_live.set(static_cast<double>(live_count));
  context.metrics.displays.set(static_cast<double>(context.broadcaster.displays("").size()));
  context.metrics.memory_heap_bytes.set(static_cast<double>(lentHeapBytes()));
  HttpReply reply;
  reply.type = "text/plain; version=0.0.4; charset=utf-8";
  reply.text = context.metrics.text();
  return reply;
}

HttpReply healthReply(const WebContext& context) {
  HttpReply reply;
  reply.type = "text/plain; charset=utf-8";
  const absl::Status grpc = context.grpc_health();
  reply.status = context.draining || !grpc.ok() ? 503 : 200;
  reply.text = context.draining ? "draining\n" : "serving\n";
  if (!context.draining && !grpc.ok()) {
    reply.text = strCat("the gRPC port takes no clients: ", grpc.message(), "\n");
  }
  return reply;
}

// A plain GET of the WebSocket's URL tells a browser, which does not let pages read why an upgrade
// was refused, what is wrong with it.
HttpReply webSocketReply(const WebContext& context, const HttpRequest& request, const Url& url) {
  const absl::StatusOr<Caller> caller = admitViewer(context, request, url);
  if (!caller.ok()) return errorReply(caller.status());
  HttpReply reply =
      errorReply(426, absl::FailedPreconditionError(
                          "a plain request came to the WebSocket; accepted is an upgrade"));
  reply.headers.emplace_back("Upgrade", "websocket");
  return reply;
}

HttpReply notFoundReply(const std::string& path) {
  std::vector<std::string> known = {
      "/api/streams", "/api/displays", "/api/presets", "/api/fields", "/api/link",
      "/api/qr",      "/api/session",  "/metrics",     "/healthz",    "/ws"};
  for (const PageAsset& asset : pageAssets()) known.emplace_back(asset.path);
  const std::string suggestion = didYouMean(path, known);
  return errorReply(fieldError(
      absl::StatusCode::kNotFound, "url",
      strCat("there is no page \"", quotable(path),
             "\"; known pages: /, /api/streams, /api/displays, /api/presets, /api/fields, "
             "/api/link, /api/qr, /api/session, /metrics, /healthz, /still/STREAM/PRESET, "
             "/stream/STREAM/PRESET, /ws?stream=STREAM",
             suggestion.empty() ? "" : "; ", suggestion)));
}

// A list, or the metrics.
HttpReply listReply(const WebContext& context, const Caller& caller, const std::string& path) {
  if (path == kMetricsPage) return metricsReply(context);
  if (path == kApiStreams) {
    return jsonReply(streamsJson(context.streams, context.broadcaster, caller));
  }
  if (path == kApiDisplays) return jsonReply(displaysJson(context.broadcaster, caller));
  if (path == kApiPresets) return jsonReply(presetsJson());
  if (path == kApiFields) return jsonReply(fieldsJson());
  return notFoundReply(path);  // operations of gRPC have paths, too
}

// A redirect that also holds where a proxy serves this server below a path of its own.
std::string relativeLocation(std::string_view target, std::string_view location) {
  const std::string_view path = target.substr(0, target.find('?'));
  std::string relative;
  for (auto depth = std::ranges::count(path, '/'); depth > 1; --depth) relative += "../";
  return relative + std::string(location.substr(1));
}

// Lets pages of an allowed origin read and show the reply.
void addressTo(const std::string& origin, HttpReply& reply) {
  reply.headers.emplace_back("Access-Control-Allow-Origin", origin);
  reply.headers.emplace_back("Cross-Origin-Resource-Policy", "cross-origin");
  reply.headers.emplace_back("Vary", "Origin, Referer");
}

net::awaitable<HttpReply> route(WebContext& context, HttpRequest request) {
  const absl::StatusOr<Url> url = parseUrl(request.target);
  if (!url.ok()) co_return errorReply(url.status());
  for (const PageAsset& asset : pageAssets()) {
    if (url->path == asset.path) co_return assetReply(context, asset, request);
  }
  if (url->path == kHealthPage) co_return healthReply(context);
  if (url->path == kApiSession) co_return answerSession(context, request);
  if (url->path == kApiLink) co_return answerLink(context, request, *url);
  if (url->path == kApiQr) co_return answerQr(context, request, *url);
  if (url->path == kWebSocket) co_return webSocketReply(context, request, *url);
  if (url->path.starts_with(kStills)) co_return co_await answerStill(context, request, *url);
  if (url->path.starts_with(kPlayers)) co_return answerStream(context, request, *url);
  if (!operationOf(url->path)) co_return notFoundReply(url->path);
  const absl::StatusOr<Caller> caller = admitRequest(context, request, url->path);
  if (!caller.ok()) co_return errorReply(caller.status());
  co_return listReply(context, *caller, url->path);
}

}  // namespace

bool isStatusTarget(std::string_view target) {
  return target == kHealthPage || target == kMetricsPage;
}

std::optional<HttpReply> refusal(const WebContext& context, const HttpRequest& request) {
  const bool reads = request.method == "GET" || request.method == "HEAD";
  const bool is_session = request.target == kApiSession;
  const bool changes_session =
      is_session && (request.method == "POST" || request.method == "DELETE");
  if (!reads && !changes_session) {
    HttpReply reply =
        errorReply(405, fieldError(absl::StatusCode::kUnimplemented, "method",
                                   strCat("got ", request.method, "; accepted is GET or HEAD",
                                          is_session ? ", POST or DELETE" : "")));
    reply.headers.emplace_back("Allow", is_session ? "GET, HEAD, POST, DELETE" : "GET, HEAD");
    return reply;
  }
  absl::Status allowed = context.host_policy.checkHost(request.host);
  if (allowed.ok()) {
    allowed = request.upgrade || changes_session
                  ? context.host_policy.checkWebSocket(request.page, request.host)
                  : context.host_policy.checkPage(request.page);
  }
  if (!allowed.ok()) return errorReply(allowed);
  return std::nullopt;
}

HttpReply redirectToTls(const HttpRequest& request) {
  const absl::StatusOr<Url> url = parseUrl(request.target);
  if (!url.ok()) return errorReply(url.status());
  return redirectReply(strCat("https://", request.host, request.target));
}

net::awaitable<HttpReply> answer(WebContext& context, HttpRequest request) {
  HttpReply reply = co_await route(context, request);
  for (auto& [name, value] : reply.headers) {
    if (name == "Location") value = relativeLocation(request.target, value);
  }
  const std::string origin = context.host_policy.allowedOrigin(request.page);
  if (!origin.empty()) addressTo(origin, reply);
  co_return reply;
}

}  // namespace viewloom
