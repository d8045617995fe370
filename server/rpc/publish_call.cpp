// SPDX-License-Identifier: Apache-2.0
#include "rpc/publish_call.h"

#include <utility>
#include <vector>

#include "base/str_cat.h"
#include "messages/wire_message.h"
#include "rpc/frame_from_proto.h"
#include "rpc/read_chunk.h"
#include "rpc/report_to_proto.h"
#include "rpc/stream_name.h"

namespace viewloom {
namespace {

constexpr size_t kSessionBytesMax = 128;
// A header of the most sources, layers and planes has a third of it, 20 kB.
constexpr size_t kRequestBytesMax = size_t{64} << 10;
// Frames without a report plus reports not yet written. Over it the call reads no more, so that a
// publisher that does not read its reports holds back nobody but itself.
constexpr size_t kOpenReportsMax = 64;

// A call begins with its settings.
absl::Status refuseFirst(const char* message) {
  return invalidField(message,
                      strCat("the first message is a ", message, "; accepted first is settings"));
}

}  // namespace

absl::Status PublishCall::handleMessage(grpc::ByteBuffer& bytes) {
  {
    std::lock_guard lock(mutex_);
    heard_.restart();
  }
  if (assembly_.has_value()) {
    const auto taken_bytes = readChunk(bytes, *assembly_);
    if (taken_bytes) return taken_bytes->ok() ? noteChunk(**taken_bytes) : taken_bytes->status();
  }
  v1::PublishFramesRequest request;
  VIEWLOOM_RETURN_IF_ERROR(parseMessage(bytes, request, kRequestBytesMax));
  switch (request.message_case()) {
    case v1::PublishFramesRequest::kSettings:
      return handleSettings(request.settings());
    case v1::PublishFramesRequest::kHeader:
      return handleHeader(request.header());
    case v1::PublishFramesRequest::kChunk:
      return handleChunk(request.chunk());
    case v1::PublishFramesRequest::kHeartbeat:
      return stream_.empty() ? refuseFirst("heartbeat") : absl::OkStatus();
    case v1::PublishFramesRequest::MESSAGE_NOT_SET:
      break;
  }
  return invalidField("message",
                      "the message is empty; accepted is settings, header, chunk or heartbeat");
}

absl::Status PublishCall::handleSettings(const v1::PublishSettings& settings) {
  if (!stream_.empty())
    return invalidField("settings", "settings came again; accepted is once, as the first message");
  VIEWLOOM_RETURN_IF_ERROR(validateStreamName(settings.stream(), "settings.stream"));
  VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(caller_->mayUse(settings.stream()), "settings"));
  if (settings.session_id().size() > kSessionBytesMax) {
    return invalidField("settings.session_id",
                        strCat("the session id has ", settings.session_id().size(),
                               " bytes; accepted is 0..", kSessionBytesMax));
  }
  const auto on_takeover = [self = weak_from_this()] {
    const auto call = self.lock();
    if (call)
      call->end(
          absl::AbortedError("another call with the same session id has taken the stream over"));
  };
  auto place =
      takePublishPlace(settings, *caller_, host_, on_takeover, parts_.directory, parts_.memory);
  VIEWLOOM_RETURN_IF_ERROR(place.status());
  v1::PublishFramesResponse response;
  *response.mutable_accepted() = limitsToProto(parts_.limits);
  {
    std::lock_guard lock(mutex_);
    if (ending()) return absl::OkStatus();  // the place goes with this scope
    stream_ = settings.stream();
    session_ = place->claim->session();
    place_ = *std::move(place);
    has_heartbeats_ = settings.sends_heartbeats();
    heartbeat_is_due_ = has_heartbeats_;
    replies_.push_back(bytesFromMessage(response));
    advance();
  }
  refreshWanted();
  return absl::OkStatus();
}

absl::Status PublishCall::handleHeader(const v1::FrameHeader& header) {
  if (stream_.empty()) return refuseFirst("header");
  if (assembly_.has_value()) VIEWLOOM_RETURN_IF_ERROR(assembly_->requireComplete());
  auto format = frameFormatFromProto(header, parts_.limits);
  if (!format.ok()) {
    parts_.countOutcome(stream_, FrameOutcome::kRefused);
    return format.status();
  }
  if (format->number <= last_number_) {
    return fieldError(absl::StatusCode::kOutOfRange, "header.number",
                      strCat("the number of the frame is ", format->number,
                             "; accepted is more than ", last_number_, ", the last one"));
  }
  assembly_.reset();
  absl::StatusOr<Reservation> memory = admit(*format);
  if (!memory.ok()) {
    parts_.countOutcome(stream_, FrameOutcome::kRefused);
    return memory.status();
  }
  last_number_ = format->number;
  times_ = {};
  assembly_.emplace(*std::move(format), parts_.pool, *std::move(memory));
  return absl::OkStatus();
}

// A frame of a new size has to fit together with how it is prepared. The next ones like it are
// prepared in the memory of those before.
absl::StatusOr<Reservation> PublishCall::admit(const FrameFormat& format) {
  const uint64_t prepared_bytes = parts_.prepared_bytes(format);
  const bool is_like_last = prepared_bytes == last_prepared_bytes_;
  absl::StatusOr<Reservation> memory = admitFrame(
      parts_.memory, format, [&](const FrameFormat&) { return is_like_last ? 0 : prepared_bytes; },
      identity_);
  if (memory.ok()) last_prepared_bytes_ = prepared_bytes;
  return memory;
}

absl::Status PublishCall::handleChunk(const v1::FrameChunk& chunk) {
  if (!assembly_.has_value())
    return invalidField(
        "chunk", "a chunk came before any header; accepted first is settings, then a header");
  VIEWLOOM_RETURN_IF_ERROR(
      assembly_->addChunk(chunk.plane_index(), chunk.offset_bytes(), chunk.data()));
  return noteChunk(chunk.data().size());
}

absl::Status PublishCall::noteChunk(uint64_t data_bytes) {
  const int64_t now_ns = parts_.clock.nowNs();
  if (times_.first_chunk_ns == 0) times_.first_chunk_ns = now_ns;
  times_.last_chunk_ns = now_ns;
  parts_.metrics.received_bytes.add(static_cast<double>(data_bytes));
  caller_->noteBytes(data_bytes);
  if (assembly_->complete()) offerFrame();
  return absl::OkStatus();
}

absl::Status PublishCall::handleHalfClose() {
  if (stream_.empty())
    return invalidField(
        "settings", "the call was closed without settings; accepted is once, as the first message");
  if (assembly_.has_value() && !assembly_->complete()) {
    return invalidField(
        "chunk", strCat("the call was closed before the end of frame ", assembly_->frameNumber(),
                        "; send all chunks of a frame first"));
  }
  end(absl::OkStatus());
  return absl::OkStatus();
}

void PublishCall::dropReads() {
  assembly_.reset();
}

std::optional<grpc::ByteBuffer> PublishCall::takeMessage() {
  std::optional<grpc::ByteBuffer> message;
  if (!replies_.empty()) {
    message.emplace().Swap(&replies_.front());
    replies_.pop_front();
  } else if (wanted_.isDue()) {
    message = wanted_.take();
  } else if (heartbeat_is_due_ && !ending()) {
    heartbeat_is_due_ = false;
    v1::PublishFramesResponse response;
    response.mutable_heartbeat();
    message = bytesFromMessage(response);
  }
  if (message.has_value()) told_.restart();
  return message;
}

// Silence while this call itself reads nothing, for it has frames to report, is nobody's fault.
void PublishCall::tick() {
  if (const absl::Status status = caller_.tick(); !status.ok()) end(status);
  {
    std::lock_guard lock(mutex_);
    if (ending()) return;
    advance();  // it may be held back no longer
    if (!has_heartbeats_) return;
    if (told_.reaches(kHeartbeatTicks)) {
      heartbeat_is_due_ = true;
      advance();
    }
    if (!wantsToRead() && unreported_count_ > 0) heard_.restart();
    if (!heard_.reaches(kSilenceTicks)) return;
  }
  end(absl::UnavailableError(strCat("no heartbeat came for ", kSilence_s,
                                    " s, and the name of the stream is free again; call again to "
                                    "go on publishing")));
}

bool PublishCall::wantsToRead() const {
  return !held_back_.holds(parts_.clock.nowNs()) &&
         unreported_count_ + replies_.size() < kOpenReportsMax;
}

std::string PublishCall::stream() {
  std::lock_guard lock(mutex_);
  return stream_;
}

void PublishCall::refreshWanted() {
  std::vector<AtlasPtr> atlases;
  const std::vector<ActiveDisplayPtr> displays = parts_.broadcaster.displays(stream());
  for (const ActiveDisplayPtr& display : displays) {
    if (AtlasPtr atlas = parts_.broadcaster.newest(display->id))
      atlases.push_back(std::move(atlas));
  }
  std::lock_guard lock(mutex_);
  if (!ending() && wanted_.refresh(atlases, static_cast<uint32_t>(displays.size()))) advance();
}

}  // namespace viewloom
