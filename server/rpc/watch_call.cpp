// SPDX-License-Identifier: Apache-2.0
#include "rpc/watch_call.h"

#include <utility>

#include "messages/eye_poses_from_proto.h"
#include "messages/wire_message.h"
#include "publish/eye_intake.h"
#include "rpc/display_request.h"
#include "rpc/stream_name.h"

namespace viewloom {

absl::Status WatchCall::handleMessage(grpc::ByteBuffer& bytes) {
  const int64_t received_ns = parts_.clock.nowNs();
  std::lock_guard seat_lock(seat_mutex_);
  v1::StreamAtlasesRequest request;
  VIEWLOOM_RETURN_IF_ERROR(parseMessage(bytes, request, kDisplayRequestBytesMax));
  const bool opens = request.message_case() == v1::StreamAtlasesRequest::kOpen;
  if (opens != stream_.empty()) {
    return opens ? invalidField("open", "open came again; accepted is once, as the first message")
                 : invalidField("message", "the first message is not open; accepted first is open");
  }
  switch (request.message_case()) {
    case v1::StreamAtlasesRequest::kOpen:
      return handleOpen(request.open());
    case v1::StreamAtlasesRequest::kChange:
      return handleChange(request.change());
    case v1::StreamAtlasesRequest::kEyePoses:
      return handleEyePoses(request.eye_poses(), received_ns);
    case v1::StreamAtlasesRequest::kPresented:
      notePresented(request.presented());
      return absl::OkStatus();
    case v1::StreamAtlasesRequest::kClockProbe:
      noteProbe(request.clock_probe(), received_ns);
      return absl::OkStatus();
    case v1::StreamAtlasesRequest::MESSAGE_NOT_SET:
      break;
  }
  return invalidField("message",
                      "the message is empty; accepted is change, eye_poses, presented or "
                      "clock_probe");
}

absl::Status WatchCall::handleOpen(const v1::OpenDisplay& request) {
  VIEWLOOM_RETURN_IF_ERROR(validateStreamName(request.stream(), "open.stream"));
  VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(caller_->mayUse(request.stream()), "open"));
  VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(asked_.open(request, parts_.limits), "open"));
  if (!request.wait_for_stream() && !parts_.directory.exists(request.stream()))
    return noSuchStream(request.stream(), "open.stream", parts_.directory, *caller_);
  stream_ = request.stream();
  {
    std::lock_guard lock(mutex_);
    outbox_.limit(request.count());
  }
  // An unknown stream is waited for in the same seat: it is watched before it is there.
  VIEWLOOM_RETURN_IF_ERROR(takeSeat("open.display"));
  std::lock_guard lock(mutex_);
  wants_heartbeats_ = request.wants_heartbeats();
  heartbeat_is_due_ = wants_heartbeats_;
  advance();
  return absl::OkStatus();
}

absl::Status WatchCall::handleChange(const v1::ChangeDisplay& request) {
  VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(asked_.change(request, parts_.limits), "change"));
  return takeSeat("change.display");
}

// Poses that are overtaken by newer ones are dropped: one slot holds what is served next.
absl::Status WatchCall::handleEyePoses(const v1::EyePoses& request, int64_t received_ns) {
  if (eyes_ == nullptr) {
    return fieldError(absl::StatusCode::kFailedPrecondition, "eye_poses",
                      "eye poses came for a display that does not track eyes; accepted are they "
                      "for a StereoDisplay with tracked set");
  }
  absl::StatusOr<EyePoses> poses = eyePosesFromProto(request, trackedEyeCount(asked_.display()));
  VIEWLOOM_RETURN_IF_ERROR(poses.status());
  poses->received_ns = received_ns;
  uint64_t display_id = 0;
  {
    std::lock_guard lock(mutex_);
    if (subscription_ == nullptr) return absl::OkStatus();  // the call has begun to end
    display_id = subscription_->displayId();
  }
  return takeEyePoses(*std::move(poses), {asked_.display(), display_id, *eyes_}, parts_.broadcaster,
                      parts_.eyes);
}

void WatchCall::notePresented(const v1::Presented& presented) {
  parts_.metrics.atlases_presented.add();
  std::lock_guard lock(mutex_);
  const std::optional<double> latency_s =
      outbox_.sentPoses().latencySeconds(presented.sequence(), presented.presented_time_ns());
  if (latency_s) parts_.metrics.motion_to_image.observe(*latency_s);
}

void WatchCall::noteProbe(const v1::ClockProbe& probe, int64_t received_ns) {
  std::lock_guard lock(mutex_);
  clock_replies_.note(probe.client_time_ns(), received_ns);
  advance();
}

absl::Status WatchCall::handleHalfClose() {
  if (stream_.empty())
    return invalidField("open",
                        "the call was closed without open; accepted is once, as the first message");
  return absl::OkStatus();
}

void WatchCall::handleWritten() {
  bool counted_out = false;
  const int64_t now_ns = parts_.clock.nowNs();
  {
    std::lock_guard lock(mutex_);
    if (subscription_ && writes_end_) subscription_->endAtlas(now_ns);
    if (subscription_) subscription_->endWrite(now_ns);
    counted_out = outbox_.isThrough();
  }
  if (counted_out) end(absl::OkStatus());
}

void WatchCall::release() {
  std::unique_ptr<Broadcaster::Subscription> left;
  {
    std::lock_guard lock(mutex_);
    left = std::move(subscription_);
    quota_ = nullptr;
    outbox_.close(draining_);
  }
  leave(std::move(left));
}

void WatchCall::endUnlessWatching() {
  {
    std::lock_guard lock(mutex_);
    if (subscription_ != nullptr) return;
  }
  end(absl::UnavailableError(kDrainMessage));
}

// Replies about the time go before atlases, but no more often than every other message: a client
// that floods the call with probes still gets atlases.
std::optional<grpc::ByteBuffer> WatchCall::takeMessage() {
  std::optional<grpc::ByteBuffer> message;
  writes_end_ = false;
  if (!std::exchange(replied_last_, false)) message = takeReply();
  if (!message.has_value()) message = takeOfAtlas();
  if (!message.has_value()) message = takeReply();
  if (!message.has_value()) message = takeHeartbeat();
  if (!message.has_value()) return std::nullopt;
  told_.restart();
  caller_->noteBytes(message->Length());
  return message;
}

std::optional<grpc::ByteBuffer> WatchCall::takeOfAtlas() {
  const int64_t now_ns = parts_.clock.nowNs();
  if (subscription_ && outbox_.isStuck()) subscription_->wantSelfContained(now_ns);
  const bool has_budget = !subscription_ || subscription_->mayBegin(now_ns);
  std::optional<grpc::ByteBuffer> message =
      outbox_.take((!ending() || draining_) && (has_budget || draining_));
  writes_end_ = outbox_.hasEndedAtlas();
  if (message && subscription_) subscription_->beginWrite(message->Length(), now_ns);
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
  if (const absl::Status status = caller_.tick(); !status.ok()) end(status);
  leaveChainIfLost();
  if (const absl::Status status = followLine(); !status.ok()) end(status);
  std::lock_guard lock(mutex_);
  if (ending()) return;
  if (wants_heartbeats_ && told_.reaches(kHeartbeatTicks)) heartbeat_is_due_ = true;
  advance();  // an atlas may wait until the reader may have more in a second
}

std::optional<grpc::ByteBuffer> WatchCall::takeReply() {
  if (ending()) return std::nullopt;
  std::optional<grpc::ByteBuffer> reply = clock_replies_.take(parts_.clock.nowNs());
  replied_last_ = reply.has_value();
  return reply;
}

}  // namespace viewloom
