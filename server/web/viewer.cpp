// SPDX-License-Identifier: Apache-2.0
#include "web/viewer.h"

#include <new>

#include "admission/request_boundary.h"
#include "messages/message_from_json.h"
#include "viewloom/v1/web_socket.pb.h"
#include "web/atlas_message.h"
#include "web/close_reason.h"
#include "web/http_reply.h"
#include "web/once_ended.h"

namespace viewloom {
namespace {

// One being shown while the next is on its way.
constexpr size_t kUnderWayCountMax = 2;

}  // namespace

Viewer::Viewer(WebContext& context, Caller caller, WebStream stream, QueryParameters parameters,
               std::string identity)
    : context_(context),
      caller_(std::move(caller)),
      socket_(std::move(stream)),
      awake_(socket_.get_executor()),
      next_read_(socket_.get_executor()),
      write_end_(socket_.get_executor()),
      pace_(context.options.message_rate),
      parameters_(std::move(parameters)),
      identity_(std::move(identity)),
      eyes_(context) {
  context_.metrics.subscribers[Transport::kWeb].add(1);
}

Viewer::~Viewer() {
  context_.metrics.subscribers[Transport::kWeb].add(-1);
}

net::awaitable<void> Viewer::run(http::request<http::empty_body> request, std::string protocol) {
  const auto self = shared_from_this();
  socket_.next_layer().expiresNever();
  socket_.set_option(
      websocket::stream_base::timeout{.handshake_timeout = context_.options.request_timeout,
                                      .idle_timeout = context_.options.idle_timeout,
                                      .keep_alive_pings = true});
  socket_.auto_fragment(false);
  socket_.read_message_max(context_.options.message_bytes_max);
  if (!protocol.empty()) {
    socket_.set_option(
        websocket::stream_base::decorator([protocol](websocket::response_type& response) {
          response.set(http::field::sec_websocket_protocol, protocol);
        }));
  }
  ErrorCode error;
  co_await socket_.async_accept(request, into(error));
  if (error) co_return;
  if (const absl::Status status = unlessThrown([&] { return open(); }); !status.ok()) {
    co_await writeText(errorJson(status), error);
    co_await close(status);
    co_return;
  }
  net::co_spawn(
      socket_.get_executor(), [self] { return self->writeMessages(); },
      OnceEnded([self] { self->cut(); }));
  co_await readMessages();
  subscription_.reset();
  cut();  // also what is being written: nobody reads it
}

void Viewer::leave() {
  leaving_ = true;
  wake();
}

void Viewer::cut() {
  gone_ = true;
  next_read_.cancel();
  socket_.next_layer().close();
  wake();
}

absl::Status Viewer::open() {
  const absl::StatusOr<AskedDisplay> asked = askedDisplay(parameters_);
  VIEWLOOM_RETURN_IF_ERROR(asked.status());
  return inParameters(subscribe(*asked), parameters_);
}

net::awaitable<void> Viewer::readMessages() {
  beast::flat_buffer buffer;
  for (;;) {
    ErrorCode error;
    co_await socket_.async_read(buffer, into(error));
    if (error) co_return;
    const auto bytes = buffer.cdata();
    const absl::Status status = unlessThrown([&] {
      return takeMessage({static_cast<const char*>(bytes.data()), bytes.size()});
    });
    buffer.consume(bytes.size());
    if (absl::IsInternal(status)) {
      failure_ = status;
    } else if (!status.ok()) {
      replies_.error(errorJson(status));
    }
    wake();
    co_await keepPace(bytes.size(), error);
    if (error) co_return;
  }
}

net::awaitable<void> Viewer::keepPace(size_t message_bytes, ErrorCode& error) {
  const int64_t delay_ns = pace_.delayNs(context_.clock.nowNs(), message_bytes);
  if (delay_ns == 0) co_return;
  next_read_.expires_after(std::chrono::nanoseconds(delay_ns));
  co_await next_read_.async_wait(into(error));
}

absl::Status Viewer::takeMessage(std::string_view text) {
  v1::ViewerMessage message;
  const absl::Status status = messageFromJson(text, context_.options.message_bytes_max, message);
  if (!status.ok()) {
    // Viewers count their changes, also those in vain.
    const std::string field = fieldOf(status);
    if (field.starts_with("change")) ++change_count_;
    return field.empty() ? withFieldPrefix(status, "message") : status;
  }
  switch (message.message_case()) {
    case v1::ViewerMessage::kShown:
      noteShown(message.shown());
      return absl::OkStatus();
    case v1::ViewerMessage::kChange:
      ++change_count_;
      return withFieldPrefix(change(message.change()), "change");
    case v1::ViewerMessage::kPing:
      replies_.pong(message.ping());
      return absl::OkStatus();
    case v1::ViewerMessage::kEyePoses:
      return eyes_.take(message.eye_poses());
    case v1::ViewerMessage::kPresented:
      eyes_.notePresented(message.presented());
      return absl::OkStatus();
    case v1::ViewerMessage::kClockProbe:
      replies_.clock(message.clock_probe().client_time_ns(), context_.clock.nowNs());
      return absl::OkStatus();
    case v1::ViewerMessage::MESSAGE_NOT_SET:
      break;
  }
  return invalidField("message",
                      "the message is empty; accepted is {\"shown\": DELIVERY}, {\"change\": "
                      "{\"display\": ..., \"encoding\": ...}}, {\"eye_poses\": {\"eyes\": [...]}}, "
                      "{\"presented\": ...}, {\"clock_probe\": ...} or {\"ping\": NUMBER}");
}

absl::Status Viewer::change(const v1::ChangeDisplay& changes) {
  AskedDisplay changed = asked_;
  if (changes.has_display()) changed.display = changes.display();
  if (changes.has_encoding()) changed.encoding = changes.encoding();
  return subscribe(changed);
}

void Viewer::noteShown(uint64_t delivery) {
  while (!under_way_.empty() && under_way_.front().delivery <= delivery) {
    shown_ns_ = context_.clock.nowNs() - under_way_.front().written_ns;
    under_way_.pop_front();
  }
}

// A viewer that runs out of memory is cut: a close frame takes memory, too.
net::awaitable<void> Viewer::writeMessages() {
  const auto self = shared_from_this();
  try {
    co_await writeUntilEnd();
    co_return;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& thrown) {
    failure_ = refusalFor(thrown);
  }
  co_await close(*failure_);
}

net::awaitable<void> Viewer::writeUntilEnd() {
  ErrorCode error;
  while (!error && !gone_) {
    if (std::optional<std::string> text = replies_.take(context_.clock.nowNs())) {
      co_await writeText(*std::move(text), error);
      continue;
    }
    leaveChainIfLost();
    followLine();
    std::optional<absl::Status> ended = failure_ ? failure_ : inbox_->ended();
    if (absl::Status status = caller_.recheck(); !ended && !status.ok()) ended = std::move(status);
    if (leaving_) ended = absl::OkStatus();
    if (ended) {
      if (!ended->ok()) co_await writeText(errorJson(*ended), error);
      co_await close(*ended);
      co_return;
    }
    const int64_t now_ns = context_.clock.nowNs();
    if (under_way_.size() < kUnderWayCountMax && subscription_->mayBegin(now_ns)) {
      if (inbox_->isStuck()) subscription_->wantSelfContained(now_ns);
      if (auto arrival = inbox_->take()) {
        co_await writeAtlas(*std::move(arrival), error);
        continue;
      }
    }
    ErrorCode woken;
    awake_.expires_after(kRecheckInterval);
    co_await awake_.async_wait(into(woken));
  }
}

void Viewer::beginOfWrite() {
  write_end_.expires_after(context_.options.transfer_timeout);
  write_end_.async_wait([weak = weak_from_this()](const ErrorCode& ended) {
    const auto self = ended ? nullptr : weak.lock();
    if (self) self->cut();
  });
}

net::awaitable<void> Viewer::writeText(std::string text, ErrorCode& error) {
  socket_.text(true);
  beginOfWrite();
  co_await socket_.async_write(net::buffer(text), into(error));
  endOfWrite();
}

net::awaitable<void> Viewer::writeAtlas(AtlasInbox::Arrival arrival, ErrorCode& error) {
  const int64_t now_ns = context_.clock.nowNs();
  under_way_.push_back({++delivery_count_, now_ns});
  eyes_.noteSent(*arrival.atlas);
  const AtlasMessage message(arrival.atlas,
                             {.delivery = delivery_count_,
                              .change_count = change_count_,
                              .dropped_count = dropped_before_ + inbox_->replacedCount(),
                              .mailbox_ns = now_ns - arrival.arrived_ns,
                              .shown_ns = shown_ns_});
  std::vector<net::const_buffer> buffers;
  for (const auto& part : message.parts()) buffers.emplace_back(part.data(), part.size());
  socket_.binary(true);
  beginOfWrite();
  subscription_->beginWrite(message.sizeBytes(), now_ns);
  co_await socket_.async_write(buffers, into(error));
  endOfWrite();
  if (subscription_) subscription_->endAtlas(context_.clock.nowNs());
  if (error) co_return;
  context_.metrics.atlases_sent[Transport::kWeb].add();
  context_.metrics.sent_bytes[Transport::kWeb].add(static_cast<double>(message.sizeBytes()));
  caller_.noteBytes(message.sizeBytes());
}

net::awaitable<void> Viewer::close(const absl::Status& status) {
  subscription_.reset();
  const websocket::close_reason reason = closeReason(status);
  ErrorCode error;
  beginOfWrite();
  co_await socket_.async_close(reason, into(error));
  endOfWrite();
}

}  // namespace viewloom
