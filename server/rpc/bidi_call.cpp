// SPDX-License-Identifier: Apache-2.0
#include "rpc/bidi_call.h"

#include <utility>

#include <grpcpp/server_context.h>

#include "admission/request_boundary.h"
#include "rpc/status_to_grpc.h"

namespace viewloom {

namespace {

// Where there is no memory for the whole status, its code is told with a message that needs none.
grpc::Status grpcStatus(const absl::Status& status) noexcept {
  try {
    return statusToGrpc(status);
  } catch (const std::exception&) {
    return {static_cast<grpc::StatusCode>(status.code()), "out of memory"};
  }
}

}  // namespace

void BidiCall::setContext(const grpc::CallbackServerContext& context) {
  std::lock_guard lock(context_mutex_);
  context_ = &context;
}

void BidiCall::open() {
  std::lock_guard lock(mutex_);
  self_ = shared_from_this();  // nothing is thrown from here on: gRPC would never call OnDone()
  opened_ = true;
  advance();
}

void BidiCall::end(const absl::Status& status) {
  endWith(grpcStatus(status));
}

void BidiCall::endWith(grpc::Status status) {
  bool handling = false;
  {
    std::lock_guard lock(mutex_);
    if (end_status_.has_value()) return;
    end_status_ = std::move(status);
    handling = handling_;
  }
  letGo();
  if (!handling) dropReads();
  std::lock_guard lock(mutex_);
  advance();
}

void BidiCall::cutIfUnread(uint32_t ticks_max) {
  {
    std::lock_guard lock(mutex_);
    if (!writing_ || !unread_.reaches(ticks_max)) return;
  }
  std::lock_guard lock(context_mutex_);
  if (context_ != nullptr) context_->TryCancel();
}

void BidiCall::OnReadDone(bool ok) {
  {
    std::lock_guard lock(mutex_);
    half_closed_ = !ok;
    handling_ = !end_status_.has_value();
  }
  if (handling_) handle(ok);
  incoming_.Clear();
  std::lock_guard lock(mutex_);
  reading_ = false;
  advance();
}

void BidiCall::handle(bool ok) {
  const auto begun = std::chrono::steady_clock::now();
  const absl::Status status =
      unlessThrown([&] { return ok ? handleMessage(incoming_) : handleHalfClose(); });
  if (!status.ok()) refuse(status, begun);
  bool ended = false;
  {
    std::lock_guard lock(mutex_);
    handling_ = false;
    ended = end_status_.has_value();
  }
  if (ended) dropReads();
}

void BidiCall::refuse(const absl::Status& status, std::chrono::steady_clock::time_point begun) {
  if (refusal_seconds_ != nullptr) {
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
    refusal_seconds_->observe(took.count());
  }
  end(status);
}

void BidiCall::OnWriteDone(bool ok) {
  if (ok) {
    const absl::Status status = unlessThrown([this] {
      handleWritten();
      return absl::OkStatus();
    });
    if (!status.ok()) end(status);
  } else {
    OnCancel();
  }
  std::lock_guard lock(mutex_);
  outgoing_.Clear();
  writing_ = false;
  advance();
}

void BidiCall::OnCancel() {
  {
    std::lock_guard lock(mutex_);
    cancelled_ = true;
  }
  endWith({grpc::StatusCode::CANCELLED, "cancelled"});  // so short that it takes no memory
  std::lock_guard lock(mutex_);
  advance();
}

void BidiCall::OnDone() {
  {
    std::lock_guard lock(context_mutex_);
    context_ = nullptr;
  }
  if (releases_when_done_) {
    letGo();
    dropReads();
  }
  // The last reaction: with its own reference the call may go, once nobody outside holds it.
  const std::shared_ptr<BidiCall> self = std::move(self_);
}

void BidiCall::letGo() {
  try {
    release();
  } catch (const std::exception& thrown) {
    noteThrown("the end of a call", thrown);
  }
}

// Parts of a message may be half taken, so that nothing can follow it.
std::optional<grpc::ByteBuffer> BidiCall::nextMessage() {
  try {
    return takeMessage();
  } catch (const std::exception& thrown) {
    releases_when_done_ = !end_status_.has_value();
    if (releases_when_done_) end_status_ = grpcStatus(refusalFor(thrown));
    return std::nullopt;
  }
}

void BidiCall::advance() {
  if (finished_ || !opened_) return;
  if (!writing_ && !cancelled_) {
    if (std::optional<grpc::ByteBuffer> message = nextMessage()) {
      outgoing_ = *std::move(message);
      writing_ = true;
      unread_.restart();
      grpc::WriteOptions options;
      if (moreFollows()) options.set_buffer_hint();
      if (waitsForSocket()) options.set_write_through();
      StartWrite(&outgoing_, options);
    }
  }
  if (!end_status_.has_value()) {
    if (reading_ || half_closed_ || !wantsToRead()) return;
    reading_ = true;
    StartRead(&incoming_);
  } else if (!writing_ && !handling_ && (cancelled_ || mayFinish())) {
    finished_ = true;
    Finish(*std::exchange(end_status_, grpc::Status()));
  }
}

}  // namespace viewloom
