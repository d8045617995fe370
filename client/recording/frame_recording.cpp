// SPDX-License-Identifier: Apache-2.0
#include "recording/frame_recording.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/str_cat.h"
#include "lib/frame_messages.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom {
namespace {

// In the order of the wire.
std::vector<uint64_t> planeBytes(const v1::FrameHeader& header) {
  std::vector<uint64_t> bytes;
  for (const v1::Source& source : header.sources()) {
    for (const v1::Layer& layer : source.layers()) {
      for (const v1::Plane& plane : layer.planes()) bytes.push_back(plane.bytes_count());
    }
  }
  return bytes;
}

}  // namespace

FrameRecorder::FrameRecorder(std::unique_ptr<RecordingWriter> writer, const Clock& clock)
    : writer_(std::move(writer)), clock_(clock) {}

absl::StatusOr<std::unique_ptr<FrameRecorder>> FrameRecorder::create(
    const std::filesystem::path& path, const Clock& clock) {
  auto writer = RecordingWriter::create(path, RecordingKind::kFrames);
  if (!writer.ok()) return writer.status();
  return std::unique_ptr<FrameRecorder>(new FrameRecorder(*std::move(writer), clock));
}

absl::Status FrameRecorder::add(const WireFrame& frame) {
  if (frame.header.number() <= last_number_) return absl::OkStatus();
  last_number_ = frame.header.number();
  const int64_t now_ns = clock_.nowNs();
  if (!start_ns_) start_ns_ = now_ns;
  absl::Status status;
  takeFrameMessages(frame, [&](const FrameMessage& message) {
    status = writer_->add(now_ns - *start_ns_, message.head, message.data);
    return status.ok();
  });
  VIEWLOOM_RETURN_IF_ERROR(status);
  writer_->markWhole();
  ++frame_count_;
  return absl::OkStatus();
}

FrameRecordingReader::FrameRecordingReader(std::unique_ptr<RecordingReader> reader)
    : reader_(std::move(reader)) {}

absl::StatusOr<std::unique_ptr<FrameRecordingReader>> FrameRecordingReader::open(
    const std::filesystem::path& path) {
  auto reader = RecordingReader::open(path, RecordingKind::kFrames);
  if (!reader.ok()) return reader.status();
  return std::unique_ptr<FrameRecordingReader>(new FrameRecordingReader(*std::move(reader)));
}

absl::Status FrameRecordingReader::takeHeader(const RecordedMessage& message,
                                              RecordedFrame& frame) {
  v1::PublishFramesRequest request;
  if (!request.ParseFromString(message.bytes) || !request.has_header()) {
    return reader_->refuse("has no header of a frame where one must come,");
  }
  frame.time_ns = message.time_ns;
  frame.frame.header = std::move(*request.mutable_header());
  uint64_t rest_bytes = reader_->restBytes();
  for (const uint64_t bytes : planeBytes(frame.frame.header)) {
    if (bytes == 0) return reader_->refuse("declares a plane of 0 bytes");
    // Not added up: the sum of foreign numbers may not fit.
    is_cut_short_ = is_cut_short_ || bytes > rest_bytes;
    rest_bytes -= std::min(bytes, rest_bytes);
  }
  return absl::OkStatus();
}

absl::Status FrameRecordingReader::takeChunk(const RecordedMessage& message, uint32_t plane,
                                             uint64_t plane_bytes, std::vector<uint8_t>& bytes) {
  v1::PublishFramesRequest request;
  const bool is_chunk = request.ParseFromString(message.bytes) && request.has_chunk();
  const v1::FrameChunk& chunk = request.chunk();
  if (!is_chunk || chunk.plane_index() != plane || chunk.offset_bytes() != bytes.size() ||
      chunk.data().empty() || chunk.data().size() > plane_bytes - bytes.size()) {
    return reader_->refuse(strCat("lacks the piece of plane ", plane, " from its byte ",
                                  bytes.size(), " of ", plane_bytes));
  }
  bytes.insert(bytes.end(), chunk.data().begin(), chunk.data().end());
  return absl::OkStatus();
}

absl::StatusOr<std::optional<RecordedFrame>> FrameRecordingReader::next() {
  absl::StatusOr<std::optional<RecordedMessage>> message = reader_->next();
  if (!message.ok()) return message.status();
  if (!message->has_value() || is_cut_short_) return std::optional<RecordedFrame>();
  RecordedFrame frame;
  VIEWLOOM_RETURN_IF_ERROR(takeHeader(**message, frame));
  if (is_cut_short_) return std::optional<RecordedFrame>();
  uint32_t plane = 0;
  for (const uint64_t plane_bytes : planeBytes(frame.frame.header)) {
    std::vector<uint8_t> bytes;
    bytes.reserve(plane_bytes);  // the file has as many
    while (bytes.size() < plane_bytes) {
      message = reader_->next();
      if (!message.ok()) return message.status();
      if (!message->has_value()) {
        is_cut_short_ = true;
        return std::optional<RecordedFrame>();
      }
      VIEWLOOM_RETURN_IF_ERROR(takeChunk(**message, plane, plane_bytes, bytes));
    }
    frame.frame.planes.push_back(std::make_shared<const std::vector<uint8_t>>(std::move(bytes)));
    ++plane;
  }
  return std::optional<RecordedFrame>(std::move(frame));
}

void FrameRecordingReader::rewind() {
  reader_->rewind();
  is_cut_short_ = false;
}

}  // namespace viewloom
