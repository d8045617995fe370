// SPDX-License-Identifier: Apache-2.0
// Whether a request may have what it asks for: its token, its role, its stream, its signed link.
#pragma once

#include <string_view>

#include "access/access_control.h"
#include "web/http_reply.h"
#include "web/http_request.h"
#include "web/quilt_address.h"
#include "web/url.h"
#include "web/watch_request.h"
#include "web/web_context.h"

namespace viewloom {

// The caller of an operation (access/operations.h), by the token of the request. UNAUTHENTICATED or
// PERMISSION_DENIED otherwise.
absl::StatusOr<Caller> admitRequest(const WebContext& context, const HttpRequest& request,
                                    std::string_view operation);

// The caller who may watch what a WebSocket's address asks for. Errors as above, as
// makeWatchRequest, and as checkStream.
absl::StatusOr<Caller> admitViewer(const WebContext& context, const HttpRequest& request,
                                   const Url& url);

struct AdmittedPicture {
  Caller caller;
  QuiltAddress address;
};
// The caller who may have the picture of an address (quilt_address.h), by a token or by the link in
// the address. Errors as above.
absl::StatusOr<AdmittedPicture> admitPicture(const WebContext& context, const HttpRequest& request,
                                             Url url, const QuiltAddressForm& form);

// The part of the caller's quota that a display takes. `replaced`: see Caller::holdDisplay.
// `viewer`: whoever watches it; a tracked display is that viewer's alone.
absl::StatusOr<QuotaPartPtr> holdDisplay(const WebContext& context, const Caller& caller,
                                         const WatchRequest& request,
                                         const QuotaPart* replaced = nullptr,
                                         const void* viewer = nullptr);

// Answers /api/link?target=ADDRESS&seconds=300: the address of a picture, with a link that shows it
// to whoever has it.
HttpReply answerLink(const WebContext& context, const HttpRequest& request, const Url& url);
// Answers /api/qr?target=ADDRESS&seconds=300&page=https://HOST/: the same link below the address of
// this server's page, as the picture of a QR code.
HttpReply answerQr(const WebContext& context, const HttpRequest& request, const Url& url);

}  // namespace viewloom
