// SPDX-License-Identifier: Apache-2.0
// One player that is sent atlas after atlas as the parts of one endless reply (motion JPEG).
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "web/asio.h"
#include "web/atlas_inbox.h"
#include "web/http_reply.h"
#include "web/http_request.h"
#include "web/live_reader.h"
#include "web/url.h"
#include "web/watch_request.h"
#include "web/web_context.h"
#include "web/web_stream.h"

namespace viewloom {

// Answers /stream/STREAM_qs8x6a0.75.mjpg and /stream/STREAM/PRESET (see quilt_address.h): a reply
// whose `live` is set, or the error or redirect.
HttpReply answerStream(const WebContext& context, const HttpRequest& request, const Url& url);

// multipart/x-mixed-replace: each part is one whole JPEG. Players show a part when they have read
// the header of the next one, so that header goes out with the part before it. A picture that
// stands is repeated. While a part is being written only the newest atlas is kept: a slow player
// skips atlases and costs no memory. The end is the last picture once more, and the closing
// boundary.
//
// Thread-safety: subscribe() and run() once; everything happens on the strand.
class MultipartStream final : public LiveReader,
                              public std::enable_shared_from_this<MultipartStream> {
 public:
  // It ends once the identity of the caller does not hold any more. `identity`: see Subscriber.
  MultipartStream(WebContext& context, Caller caller, net::any_io_executor strand,
                  std::string identity);
  ~MultipartStream() override;

  // Errors as Broadcaster::subscribe.
  absl::Status subscribe(const WatchRequest& request);
  // Serves until either side goes. `head`: the reply up to its body.
  net::awaitable<void> run(WebStream stream, http::response<http::empty_body> head);
  void leave() override;
  void cut() override;

 private:
  net::awaitable<void> readUntilGone();
  net::awaitable<void> writeParts(ErrorCode& error);
  net::awaitable<void> writeLast(ErrorCode& error);
  // Writes the shown part and its end.
  net::awaitable<void> writePart(std::string end, ErrorCode& error);
  net::awaitable<void> writeText(std::string text, ErrorCode& error);
  void wake() { awake_.cancel(); }

  WebContext& context_;
  const Caller caller_;
  const std::string identity_;
  net::steady_timer awake_;  // waiting for it is waiting for wake(), at most kRecheckInterval
  std::optional<WebStream> stream_;  // from run() on
  std::shared_ptr<AtlasInbox> inbox_;
  std::unique_ptr<Broadcaster::Subscription> subscription_;
  AtlasPtr shown_;  // by the part that was written last
  bool leaving_ = false;
  bool gone_ = false;
};

}  // namespace viewloom
