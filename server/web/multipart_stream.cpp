// SPDX-License-Identifier: Apache-2.0
#include "web/multipart_stream.h"

#include <array>
#include <utility>

#include "absl/strings/str_cat.h"
#include "web/atlas_message.h"
#include "web/quilt_address.h"

namespace viewloom {
namespace {

constexpr const char* kType = "multipart/x-mixed-replace; boundary=viewloom";
constexpr const char* kFirstBoundary = "--viewloom\r\n";
constexpr const char* kBoundary = "\r\n--viewloom\r\n";
constexpr const char* kClosingBoundary = "\r\n--viewloom--\r\n";

}  // namespace

HttpReply answerStream(const WebContext& context, const Url& url) {
  const QuiltAddressForm form{.root = "/stream/", .extensions = {".mjpg"}};
  absl::StatusOr<QuiltAddress> address = parseQuiltAddress(url, form, context.streams);
  if (!address.ok()) return errorReply(address.status());
  if (!address->redirect.empty()) return redirectReply(address->redirect);
  HttpReply reply;
  reply.type = kType;
  reply.headers = {{"Cache-Control", "no-store"}};
  reply.live = std::move(address->request);
  return reply;
}

MultipartStream::MultipartStream(WebContext& context, net::any_io_executor strand)
    : context_(context), awake_(std::move(strand), net::steady_timer::time_point::max()) {
  context_.metrics.subscribers[Transport::kWeb].add(1);
}

MultipartStream::~MultipartStream() {
  context_.metrics.subscribers[Transport::kWeb].add(-1);
}

absl::Status MultipartStream::subscribe(const WatchRequest& request) {
  const auto executor = awake_.get_executor();
  inbox_ = std::make_shared<AtlasInbox>(context_.clock, context_.metrics.replaced[HandOver::kWeb],
                                        [executor, weak = weak_from_this()] {
                                          net::post(executor, [weak] {
                                            if (const auto self = weak.lock()) self->wake();
                                          });
                                        });
  auto subscription =
      context_.broadcaster.subscribe(request.stream, request.display, request.encoding, inbox_);
  VIEWLOOM_RETURN_IF_ERROR(subscription.status());
  subscription_ = *std::move(subscription);
  return absl::OkStatus();
}

net::awaitable<void> MultipartStream::run(beast::tcp_stream stream,
                                          http::response<http::empty_body> head) {
  const auto self = shared_from_this();
  ErrorCode error;
  stream_.emplace(std::move(stream));
  // While nothing moves nothing is written that would show that a player's machine is gone.
  stream_->socket().set_option(net::socket_base::keep_alive(true), error);
  net::co_spawn(
      awake_.get_executor(), [self] { return self->readUntilGone(); }, net::detached);
  http::response_serializer<http::empty_body> serializer(head);
  stream_->expires_after(context_.options.transfer_timeout);
  co_await http::async_write_header(*stream_, serializer, into(error));
  if (!error) co_await writeText(kFirstBoundary, error);
  if (!error) co_await writeParts(error);
  subscription_.reset();
  if (!error && !gone_) co_await writeText(kClosingBoundary, error);
  cut();  // what a player has not taken yet still reaches it; the reading ends
}

void MultipartStream::leave() {
  leaving_ = true;
  wake();
}

void MultipartStream::cut() {
  stream_->close();
}

// A player sends nothing more; reading tells when it goes, also while there is nothing to write.
// Past the stream's own clock, which is for what is written.
net::awaitable<void> MultipartStream::readUntilGone() {
  const auto self = shared_from_this();
  std::array<char, 512> ignored;
  ErrorCode error;
  while (!error) {
    co_await stream_->socket().async_read_some(net::buffer(ignored), into(error));
  }
  gone_ = true;
  cut();  // also what is being written: nobody reads it
  wake();
}

net::awaitable<void> MultipartStream::writeParts(ErrorCode& error) {
  while (!error && !gone_ && !leaving_ && !inbox_->ended()) {
    if (const auto arrival = inbox_->take()) {
      co_await writePart(*arrival->atlas, error);
      continue;
    }
    ErrorCode woken;
    co_await awake_.async_wait(into(woken));
  }
}

net::awaitable<void> MultipartStream::writePart(const EncodedAtlas& atlas, ErrorCode& error) {
  const std::vector<SharedBytes> bands = jpegBands(atlas);
  size_t jpeg_bytes = 0;
  for (const SharedBytes& band : bands) jpeg_bytes += band->size();
  const std::string head =
      absl::StrCat("Content-Type: image/jpeg\r\nContent-Length: ", jpeg_bytes,
                   "\r\nViewloom-Sequence: ", atlas.sequence,
                   "\r\nViewloom-Frame-Number: ", atlas.frame_number, "\r\n\r\n");
  const std::string boundary = kBoundary;
  std::vector<net::const_buffer> part{net::buffer(head)};
  for (const SharedBytes& band : bands) part.push_back(net::buffer(*band));
  part.push_back(net::buffer(boundary));
  stream_->expires_after(context_.options.transfer_timeout);
  co_await net::async_write(*stream_, part, into(error));
  if (error) co_return;
  context_.metrics.atlases_sent[Transport::kWeb].add();
  context_.metrics.sent_bytes[Transport::kWeb].add(static_cast<double>(net::buffer_size(part)));
}

net::awaitable<void> MultipartStream::writeText(std::string text, ErrorCode& error) {
  stream_->expires_after(context_.options.transfer_timeout);
  co_await net::async_write(*stream_, net::buffer(text), into(error));
}

}  // namespace viewloom
