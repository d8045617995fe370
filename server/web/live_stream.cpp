// SPDX-License-Identifier: Apache-2.0
#include "web/live_stream.h"

#include <netinet/tcp.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "web/admission.h"
#include "web/once_ended.h"

namespace viewloom {
namespace {

// A peer that confirms nothing for this long is gone, also while there is nothing to write.
void limitSilence(tcp::socket& socket, std::chrono::milliseconds limit) {
  const auto limit_ms = static_cast<unsigned>(limit.count());
  // Without the option, which is Linux's own, the kernel's longer limit stands.
  ::setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_USER_TIMEOUT, &limit_ms, sizeof(limit_ms));
}

}  // namespace

LiveStream::LiveStream(WebContext& context, Caller caller, net::any_io_executor strand,
                       std::string identity)
    : context_(context),
      identity_(std::move(identity)),
      caller_(std::move(caller)),
      awake_(std::move(strand)) {
  context_.metrics.subscribers[Transport::kWeb].add(1);
}

LiveStream::~LiveStream() {
  context_.metrics.subscribers[Transport::kWeb].add(-1);
}

absl::Status LiveStream::subscribe(const WatchRequest& request) {
  absl::StatusOr<QuotaPartPtr> quota = holdDisplay(context_, caller_, request);
  VIEWLOOM_RETURN_IF_ERROR(quota.status());
  const auto executor = awake_.get_executor();
  inbox_ = std::make_shared<AtlasInbox>(
      context_.clock, context_.metrics.replaced[HandOver::kWeb],
      [executor, weak = weak_from_this()] {
        net::post(executor, [weak] {
          if (const auto self = weak.lock()) self->wake();
        });
      },
      identity_, *std::move(quota));
  auto subscription =
      context_.broadcaster.subscribe(request.stream, request.display, request.encoding, inbox_);
  VIEWLOOM_RETURN_IF_ERROR(subscription.status());
  subscription_ = *std::move(subscription);
  return absl::OkStatus();
}

net::awaitable<void> LiveStream::run(WebStream stream, http::response<http::empty_body> head) {
  const auto self = shared_from_this();
  ErrorCode error;
  stream_.emplace(std::move(stream));
  limitSilence(stream_->socket(), context_.options.transfer_timeout);
  stream_->expiresNever();  // a read takes the clock with it that stands when it begins
  net::co_spawn(
      awake_.get_executor(), [self] { return self->readUntilGone(); },
      OnceEnded([self] { self->cut(); }));
  http::response_serializer<http::empty_body> serializer(head);
  stream_->expiresAfter(context_.options.transfer_timeout);
  co_await http::async_write_header(*stream_, serializer, into(error));
  if (!error) co_await writeAtlases(error);
  subscription_.reset();
  if (!error && !gone_) co_await writeEnd(error);
  cut();  // what a player has not taken yet still reaches it; the reading ends
}

void LiveStream::leave() {
  leaving_ = true;
  wake();
}

void LiveStream::cut() {
  if (stream_) stream_->close();
}

// A player sends nothing more; reading tells when it goes, also while there is nothing to write.
net::awaitable<void> LiveStream::readUntilGone() {
  const auto self = shared_from_this();
  std::array<char, 512> ignored;
  ErrorCode error;
  while (!error) {
    co_await stream_->async_read_some(net::buffer(ignored), into(error));
  }
  gone_ = true;
  cut();  // also what is being written: nobody reads it
  wake();
}

bool LiveStream::isOver() const {
  return gone_ || leaving_ || inbox_->ended() || !caller_.recheck().ok();
}

net::awaitable<void> LiveStream::waitUntil(Time time) {
  awake_.expires_at(std::min<Time>(time, now() + kRecheckInterval));
  ErrorCode woken;
  co_await awake_.async_wait(into(woken));
}

net::awaitable<void> LiveStream::write(std::vector<net::const_buffer> parts, ErrorCode& error) {
  stream_->expiresAfter(context_.options.transfer_timeout);
  co_await net::async_write(*stream_, parts, into(error));
  if (error) co_return;
  context_.metrics.sent_bytes[Transport::kWeb].add(static_cast<double>(net::buffer_size(parts)));
  caller_.noteBytes(net::buffer_size(parts));
}

}  // namespace viewloom
