// SPDX-License-Identifier: Apache-2.0
#include "lib/frame_messages.h"

#include <algorithm>
#include <array>

#include "messages/wire_message.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom {
namespace {

constexpr DataFields kChunkData{.part = v1::PublishFramesRequest::kChunkFieldNumber,
                                .data = v1::FrameChunk::kDataFieldNumber};

FrameMessage headerMessage(const v1::FrameHeader& header) {
  v1::PublishFramesRequest request;
  *request.mutable_header() = header;
  return {.head = request.SerializeAsString(), .plane = nullptr, .data = {}};
}

FrameMessage chunkMessage(const WireFrame& frame, size_t plane, size_t offset_bytes,
                          size_t size_bytes) {
  v1::FrameChunk chunk;
  chunk.set_plane_index(static_cast<uint32_t>(plane));
  chunk.set_offset_bytes(offset_bytes);
  const SharedBytes& bytes = frame.planes[plane];
  return {.head = headOfMessage(chunk, kChunkData, size_bytes),
          .plane = bytes,
          .data = std::span(*bytes).subspan(offset_bytes, size_bytes)};
}

}  // namespace

grpc::ByteBuffer bytesOf(const FrameMessage& message) {
  const grpc::Slice head(message.head);
  if (message.plane == nullptr) return {&head, 1};
  const auto offset = static_cast<size_t>(message.data.data() - message.plane->data());
  const std::array slices{head, sliceOf(message.plane, offset, message.data.size())};
  return {slices.data(), slices.size()};
}

bool takeFrameMessages(const WireFrame& frame, const TakeFrameMessage& take,
                       const std::function<size_t()>& chunk_bytes) {
  if (!take(headerMessage(frame.header))) return false;
  for (size_t plane = 0; plane < frame.planes.size(); ++plane) {
    const size_t plane_bytes = frame.planes[plane]->size();
    for (size_t offset = 0, size = 0; offset < plane_bytes; offset += size) {
      size = std::min(chunk_bytes(), plane_bytes - offset);
      if (!take(chunkMessage(frame, plane, offset, size))) return false;
    }
  }
  return true;
}

}  // namespace viewloom
