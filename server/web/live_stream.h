// SPDX-License-Identifier: Apache-2.0
// One player that is sent atlas after atlas as one endless reply.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "web/asio.h"
#include "web/atlas_inbox.h"
#include "web/live_reader.h"
#include "web/watch_request.h"
#include "web/web_context.h"
#include "web/web_stream.h"

namespace viewloom {

// While something is being written only the newest atlas is kept: a slow player skips atlases and
// costs no memory. Subclasses write the body.
//
// Thread-safety: subscribe() and run() once; everything happens on the strand.
class LiveStream : public LiveReader, public std::enable_shared_from_this<LiveStream> {
 public:
  // It ends once the identity of the caller does not hold any more. `identity`: see Subscriber.
  LiveStream(WebContext& context, Caller caller, net::any_io_executor strand, std::string identity);
  ~LiveStream() override;

  // Errors as Broadcaster::subscribe.
  virtual absl::Status subscribe(const WatchRequest& request);
  // Serves until either side goes. `head`: the reply up to its body.
  net::awaitable<void> run(WebStream stream, http::response<http::empty_body> head);
  void leave() override;
  void cut() override;

 protected:
  using Time = net::steady_timer::time_point;
  static Time now() { return net::steady_timer::clock_type::now(); }

  // Writes atlases while !isOver(), and returns after an error.
  virtual net::awaitable<void> writeAtlases(ErrorCode& error) = 0;
  // Ends the body in good order.
  virtual net::awaitable<void> writeEnd(ErrorCode& error) = 0;

  // Whether the player, the server, the display or the caller's right has gone.
  bool isOver() const;
  // Whether the player is there, and is not asked to leave. From any thread.
  bool isWanted() const { return !gone_ && !leaving_; }
  // Until wake(), until that time, or until the right of the caller is to be looked at again.
  net::awaitable<void> waitUntil(Time time);
  // Counts what it writes for the caller. The bytes have to live as long.
  net::awaitable<void> write(std::vector<net::const_buffer> parts, ErrorCode& error);
  // Ends a wait; on the strand.
  void wake() { awake_.cancel(); }
  net::any_io_executor strand() { return awake_.get_executor(); }
  AtlasInbox& inbox() { return *inbox_; }

  WebContext& context_;
  const std::string identity_;

 private:
  net::awaitable<void> readUntilGone();

  const Caller caller_;
  net::steady_timer awake_;  // waiting for it is waiting for wake(), at most kRecheckInterval
  std::optional<WebStream> stream_;  // from run() on
  std::shared_ptr<AtlasInbox> inbox_;
  std::unique_ptr<Broadcaster::Subscription> subscription_;
  std::atomic<bool> leaving_ = false;
  std::atomic<bool> gone_ = false;
};

}  // namespace viewloom
