// SPDX-License-Identifier: Apache-2.0
// One browser (or other WebSocket client) that watches a stream.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "publish/fall_outs.h"
#include "web/asio.h"
#include "web/asked_display.h"
#include "web/atlas_inbox.h"
#include "web/live_reader.h"
#include "web/message_pace.h"
#include "web/text_replies.h"
#include "web/url.h"
#include "web/viewer_eyes.h"
#include "web/watch_request.h"
#include "web/web_context.h"
#include "web/web_stream.h"

namespace viewloom {

// Down go atlases (see atlas_message.h; their header also carries "delivery", which counts from 1)
// and text messages (text_replies.h). Up come proto ViewerMessages as JSON.
// At most two atlases are under way to a client; of those that come meanwhile only the newest is
// kept, or what AtlasQueue keeps of chained video.
//
// Thread-safety: run() once, leave() from the strand of the stream; everything happens on it.
class Viewer final : public LiveReader, public std::enable_shared_from_this<Viewer> {
 public:
  // `caller` may watch the stream that the parameters name. The viewer ends once the identity of
  // the caller does not hold any more. `identity`: see Subscriber.
  Viewer(WebContext& context, Caller caller, WebStream stream, QueryParameters parameters,
         std::string identity);
  ~Viewer() override;

  // Shakes hands, with a WebSocket protocol unless it is "", and serves until either side goes.
  net::awaitable<void> run(http::request<http::empty_body> request, std::string protocol);
  // Sends a close frame (going away) as soon as the atlas under way is written.
  void leave() override;
  // Ends the connection at once.
  void cut() override;

 private:
  struct UnderWay {
    uint64_t delivery = 0;
    int64_t written_ns = 0;
  };

  absl::Status open();
  absl::Status subscribe(const AskedDisplay& asked);
  std::shared_ptr<AtlasInbox> makeInbox(QuotaPartPtr quota);
  // The new place takes the place of the one before.
  void sit(std::shared_ptr<AtlasInbox> inbox,
           std::unique_ptr<Broadcaster::Subscription> subscription);
  net::awaitable<void> readMessages();
  // Waits until the next message may be read.
  net::awaitable<void> keepPace(size_t message_bytes, ErrorCode& error);
  net::awaitable<void> writeMessages();
  net::awaitable<void> writeUntilEnd();
  // From now on the client has transfer_timeout to take what is written, until endOfWrite(). Pings
  // tell nothing about that: a client may answer, and read no more.
  void beginOfWrite();
  void endOfWrite() { write_end_.cancel(); }
  net::awaitable<void> writeText(std::string text, ErrorCode& error);
  net::awaitable<void> writeAtlas(AtlasInbox::Arrival arrival, ErrorCode& error);
  net::awaitable<void> close(const absl::Status& status);
  absl::Status takeMessage(std::string_view text);
  absl::Status change(const v1::ChangeDisplay& changes);
  void noteShown(uint64_t delivery);
  // Moves a client that keeps falling out of chained video to atlases that need no other.
  void leaveChainIfLost();
  // Moves to the other rung of the display where the line asks for that, and stays where it cannot.
  // Comes back where the second rung has ended.
  void followLine();
  void moveToRung(const RungMove& move);
  void wake() { awake_.cancel(); }

  WebContext& context_;
  const Caller caller_;
  websocket::stream<WebStream> socket_;
  net::steady_timer awake_;  // waiting for it is waiting for wake(), at most kRecheckInterval
  net::steady_timer next_read_;
  net::steady_timer write_end_;
  MessagePace pace_;
  const QueryParameters parameters_;
  const std::string identity_;
  AskedDisplay asked_;  // as it is served
  ViewerEyes eyes_;
  std::shared_ptr<AtlasInbox> inbox_;
  std::unique_ptr<Broadcaster::Subscription> subscription_;
  std::deque<UnderWay> under_way_;
  std::optional<absl::Status> failure_;  // INTERNAL: the session ends
  TextReplies replies_;
  FallOuts fall_outs_;
  uint64_t change_count_ = 0;  // asked for, also in vain
  uint64_t delivery_count_ = 0;
  uint64_t dropped_before_ = 0;  // by the displays watched earlier
  int64_t shown_ns_ = 0;
  bool leaving_ = false;
  bool gone_ = false;
};

}  // namespace viewloom
