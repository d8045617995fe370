// SPDX-License-Identifier: Apache-2.0
#include "rpc/read_chunk.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/wire_format_lite.h>
#include <grpcpp/support/proto_buffer_reader.h>

#include "base/check.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom {
namespace {

using google::protobuf::internal::WireFormatLite;
using google::protobuf::io::CodedInputStream;

constexpr uint32_t tagOf(int field, WireFormatLite::WireType type) {
  return WireFormatLite::MakeTag(field, type);
}

constexpr uint32_t kChunkTag =
    tagOf(v1::PublishFramesRequest::kChunkFieldNumber, WireFormatLite::WIRETYPE_LENGTH_DELIMITED);
constexpr uint32_t kPlaneTag =
    tagOf(v1::FrameChunk::kPlaneIndexFieldNumber, WireFormatLite::WIRETYPE_VARINT);
constexpr uint32_t kOffsetTag =
    tagOf(v1::FrameChunk::kOffsetBytesFieldNumber, WireFormatLite::WIRETYPE_VARINT);
constexpr uint32_t kDataTag =
    tagOf(v1::FrameChunk::kDataFieldNumber, WireFormatLite::WIRETYPE_LENGTH_DELIMITED);

struct ChunkHead {
  uint32_t plane_index = 0;
  uint64_t offset_bytes = 0;
  uint32_t data_bytes = 0;
};

// Leaves the input at the first byte of data.
std::optional<ChunkHead> readHead(CodedInputStream& input, size_t message_bytes) {
  // The length has to be that of the rest of the message.
  const auto readLength = [&]() -> std::optional<uint32_t> {
    uint32_t length = 0;
    if (!input.ReadVarint32(&length)) return std::nullopt;
    const auto position = static_cast<size_t>(input.CurrentPosition());
    if (length != message_bytes - position) return std::nullopt;
    return length;
  };
  if (input.ReadTag() != kChunkTag || !readLength()) return std::nullopt;
  ChunkHead head;
  while (true) {
    switch (input.ReadTag()) {
      case kPlaneTag:
        if (!input.ReadVarint32(&head.plane_index)) return std::nullopt;
        break;
      case kOffsetTag:
        if (!input.ReadVarint64(&head.offset_bytes)) return std::nullopt;
        break;
      case kDataTag: {
        const std::optional<uint32_t> length = readLength();
        if (!length) return std::nullopt;
        head.data_bytes = *length;
        return head;
      }
      default:
        return std::nullopt;
    }
  }
}

// Piece by piece, each where gRPC has received it.
void appendRest(CodedInputStream& input, size_t left_bytes, FrameAssembly& assembly) {
  while (left_bytes > 0) {
    const void* piece = nullptr;
    int piece_bytes = 0;
    VIEWLOOM_CHECK(input.GetDirectBufferPointer(&piece, &piece_bytes) && input.Skip(piece_bytes));
    assembly.append({static_cast<const uint8_t*>(piece), static_cast<size_t>(piece_bytes)});
    left_bytes -= static_cast<size_t>(piece_bytes);
  }
}

}  // namespace

std::optional<absl::StatusOr<uint64_t>> readChunk(grpc::ByteBuffer& bytes,
                                                  FrameAssembly& assembly) {
  grpc::ProtoBufferReader reader(&bytes);
  if (!reader.status().ok()) return std::nullopt;
  CodedInputStream input(&reader);
  const std::optional<ChunkHead> head = readHead(input, bytes.Length());
  if (!head) return std::nullopt;
  VIEWLOOM_RETURN_IF_ERROR(
      assembly.beginChunk(head->plane_index, head->offset_bytes, head->data_bytes));
  appendRest(input, head->data_bytes, assembly);
  return uint64_t{head->data_bytes};
}

}  // namespace viewloom
