// SPDX-License-Identifier: Apache-2.0
#include "web/multipart_stream.h"

#include <netinet/tcp.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "web/admission.h"
#include "web/atlas_message.h"
#include "web/once_ended.h"
#include "web/quilt_address.h"

namespace viewloom {
namespace {

using std::chrono_literals::operator""ms;

constexpr const char* kType = "multipart/x-mixed-replace; boundary=viewloom";
// The header of a part. It holds nothing that depends on the picture: it is sent before that.
constexpr const char* kOpening = "--viewloom\r\nContent-Type: image/jpeg\r\n\r\n";
constexpr const char* kNextOpening = "\r\n--viewloom\r\nContent-Type: image/jpeg\r\n\r\n";
constexpr const char* kClosingBoundary = "\r\n--viewloom--\r\n";
// A picture that no other follows is repeated after the first pause, for players that show a part
// when they have read on, and then after the second, so that proxies keep the connection open.
constexpr std::chrono::milliseconds kFirstPause = 200ms;
constexpr std::chrono::milliseconds kPause = 20'000ms;

// A peer that confirms nothing for this long is gone, also while there is nothing to write.
void limitSilence(tcp::socket& socket, std::chrono::milliseconds limit) {
  const auto limit_ms = static_cast<unsigned>(limit.count());
  // Without the option, which is Linux's own, the kernel's longer limit stands.
  ::setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_USER_TIMEOUT, &limit_ms, sizeof(limit_ms));
}

}  // namespace

HttpReply answerStream(const WebContext& context, const HttpRequest& request, const Url& url) {
  absl::StatusOr<AdmittedPicture> picture = admitPicture(context, request, url, streamForm());
  if (!picture.ok()) return errorReply(picture.status());
  if (!picture->address.redirect.empty()) return redirectReply(picture->address.redirect);
  HttpReply reply;
  reply.type = kType;
  reply.headers = {{"Cache-Control", "no-store"}};
  reply.live.emplace(HttpReply::Live{.request = std::move(picture->address.request),
                                     .caller = std::move(picture->caller)});
  return reply;
}

MultipartStream::MultipartStream(WebContext& context, Caller caller, net::any_io_executor strand,
                                 std::string identity)
    : context_(context),
      caller_(std::move(caller)),
      identity_(std::move(identity)),
      awake_(std::move(strand)) {
  context_.metrics.subscribers[Transport::kWeb].add(1);
}

MultipartStream::~MultipartStream() {
  context_.metrics.subscribers[Transport::kWeb].add(-1);
}

absl::Status MultipartStream::subscribe(const WatchRequest& request) {
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

net::awaitable<void> MultipartStream::run(WebStream stream, http::response<http::empty_body> head) {
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
  if (!error) co_await writeText(kOpening, error);
  if (!error) co_await writeParts(error);
  subscription_.reset();
  if (!error && !gone_) co_await writeLast(error);
  cut();  // what a player has not taken yet still reaches it; the reading ends
}

void MultipartStream::leave() {
  leaving_ = true;
  wake();
}

void MultipartStream::cut() {
  if (stream_) stream_->close();
}

// A player sends nothing more; reading tells when it goes, also while there is nothing to write.
net::awaitable<void> MultipartStream::readUntilGone() {
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

net::awaitable<void> MultipartStream::writeParts(ErrorCode& error) {
  using Time = net::steady_timer::time_point;
  const auto now = [] { return net::steady_timer::clock_type::now(); };
  Time repeat_time = Time::max();
  while (!error && !gone_ && !leaving_ && !inbox_->ended() && caller_.recheck().ok()) {
    auto arrival = inbox_->take();
    if (arrival || now() >= repeat_time) {
      if (arrival) shown_ = std::move(arrival->atlas);
      co_await writePart(kNextOpening, error);
      if (arrival && !error) context_.metrics.atlases_sent[Transport::kWeb].add();
      repeat_time = now() + (arrival ? kFirstPause : kPause);
      continue;
    }
    awake_.expires_at(std::min<Time>(repeat_time, now() + kRecheckInterval));
    ErrorCode woken;
    co_await awake_.async_wait(into(woken));
  }
}

// Completes the part that is open. An empty one would take the picture away.
net::awaitable<void> MultipartStream::writeLast(ErrorCode& error) {
  if (!shown_) {
    co_await writeText(kClosingBoundary, error);
  } else {
    co_await writePart(kClosingBoundary, error);
  }
}

net::awaitable<void> MultipartStream::writePart(std::string end, ErrorCode& error) {
  const AtlasPtr atlas = shown_;
  std::vector<net::const_buffer> part;
  for (const SharedBytes& band : colorBands(*atlas)) part.push_back(net::buffer(*band));
  part.push_back(net::buffer(end));
  stream_->expiresAfter(context_.options.transfer_timeout);
  co_await net::async_write(*stream_, part, into(error));
  if (error) co_return;
  context_.metrics.sent_bytes[Transport::kWeb].add(static_cast<double>(net::buffer_size(part)));
  caller_.noteBytes(net::buffer_size(part));
}

net::awaitable<void> MultipartStream::writeText(std::string text, ErrorCode& error) {
  stream_->expiresAfter(context_.options.transfer_timeout);
  co_await net::async_write(*stream_, net::buffer(text), into(error));
}

}  // namespace viewloom
