// SPDX-License-Identifier: Apache-2.0
#include "messages/wire_message.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/wire_format_lite.h>
#include <grpcpp/support/proto_buffer_reader.h>

#include "base/check.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

// Appends the tag and the length of a field whose `byte_count` bytes follow.
void appendTag(std::string& bytes, int field, size_t byte_count) {
  using google::protobuf::internal::WireFormatLite;
  google::protobuf::io::StringOutputStream stream(&bytes);
  google::protobuf::io::CodedOutputStream output(&stream);
  output.WriteTag(WireFormatLite::MakeTag(field, WireFormatLite::WIRETYPE_LENGTH_DELIMITED));
  output.WriteVarint32(static_cast<uint32_t>(byte_count));
}

}  // namespace

grpc::ByteBuffer bytesFromMessage(const google::protobuf::MessageLite& message) {
  const size_t byte_count = message.ByteSizeLong();
  grpc::Slice slice(byte_count);
  VIEWLOOM_CHECK(
      message.SerializeToArray(const_cast<uint8_t*>(slice.begin()), static_cast<int>(byte_count)));
  return grpc::ByteBuffer(&slice, 1);
}

absl::Status parseMessage(grpc::ByteBuffer& bytes, google::protobuf::MessageLite& message,
                          size_t bytes_max) {
  const size_t byte_count = bytes.Length();
  if (byte_count > bytes_max) {
    return absl::InvalidArgumentError(strCat("a ", message.GetTypeName(), " has ", byte_count,
                                             " bytes; accepted is up to ", bytes_max));
  }
  grpc::ProtoBufferReader reader(&bytes);
  if (reader.status().ok() &&
      message.ParseFromBoundedZeroCopyStream(&reader, static_cast<int>(byte_count))) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      strCat("a message of ", byte_count, " bytes is not a ", message.GetTypeName(),
             "; compare your .proto files with those of this server"));
}

grpc::Slice sliceOf(const SharedBytes& bytes, size_t offset, size_t count) {
  VIEWLOOM_CHECK(offset + count <= bytes->size());
  const auto release = [](void* held) { delete static_cast<SharedBytes*>(held); };
  // gRPC asks for a mutable pointer but only reads through it.
  return grpc::Slice(const_cast<uint8_t*>(bytes->data() + offset), count, release,
                     new SharedBytes(bytes));
}

std::string headOfMessage(const google::protobuf::MessageLite& part_without_data, DataFields fields,
                          size_t data_bytes) {
  std::string part = part_without_data.SerializeAsString();
  appendTag(part, fields.data, data_bytes);
  std::string head;
  appendTag(head, fields.part, part.size() + data_bytes);
  return head + part;
}

}  // namespace viewloom
