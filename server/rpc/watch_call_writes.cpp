// SPDX-License-Identifier: Apache-2.0
// What a WatchCall writes, and when.
#include <utility>

#include "messages/wire_message.h"
#include "rpc/watch_call.h"

namespace viewloom {

bool WatchCall::mayStartAtlas() const {
  if (pending_ == nullptr || (ending() && !draining_)) return false;
  return count_ == 0 || sent_count_ < count_;
}

// What time it is goes before atlases, but no more often than every other message: whoever floods
// the call with probes still gets them.
std::optional<grpc::ByteBuffer> WatchCall::takeMessage() {
  std::optional<grpc::ByteBuffer> message;
  if (!std::exchange(replied_last_, false)) message = takeReply();
  if (!message.has_value()) message = takeAtlasMessage();
  if (!message.has_value()) message = takeReply();
  if (!message.has_value()) message = takeHeartbeat();
  if (message.has_value()) told_.restart();
  return message;
}

std::optional<grpc::ByteBuffer> WatchCall::takeHeartbeat() {
  if (!heartbeat_is_due_ || ending()) return std::nullopt;
  heartbeat_is_due_ = false;
  v1::StreamAtlasesResponse response;
  response.mutable_heartbeat();
  return bytesFromMessage(response);
}

void WatchCall::tick() {
  std::lock_guard lock(mutex_);
  if (!wants_heartbeats_ || ending() || !told_.reaches(kHeartbeatTicks)) return;
  heartbeat_is_due_ = true;
  advance();
}

std::optional<grpc::ByteBuffer> WatchCall::takeReply() {
  if (ending()) return std::nullopt;
  std::optional<grpc::ByteBuffer> reply = clock_replies_.take(parts_.clock.nowNs());
  replied_last_ = reply.has_value();
  return reply;
}

std::optional<grpc::ByteBuffer> WatchCall::takeAtlasMessage() {
  std::optional<grpc::ByteBuffer> message;
  if (!sending_.has_value() && mayStartAtlas()) {
    message = announcements_.take(*pending_);
    if (!message.has_value()) {
      sent_poses_.note(pending_->sequence, pending_->eye_poses_time_ns);
      sending_.emplace(std::move(pending_));
    }
  }
  if (sending_.has_value()) {
    message = sending_->next();
    if (sending_->done()) {
      sending_.reset();
      ++sent_count_;
      parts_.metrics.atlases_sent[Transport::kGrpc].add();
    }
  }
  if (message.has_value()) {
    parts_.metrics.sent_bytes[Transport::kGrpc].add(static_cast<double>(message->Length()));
  }
  return message;
}

}  // namespace viewloom
