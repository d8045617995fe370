// SPDX-License-Identifier: Apache-2.0
#include "rpc/wire_message.h"

#include <grpcpp/support/proto_buffer_reader.h>

#include "base/check.h"
#include "base/str_cat.h"

namespace viewloom {

grpc::ByteBuffer bytesFromMessage(const google::protobuf::MessageLite& message) {
  const size_t byte_count = message.ByteSizeLong();
  grpc::Slice slice(byte_count);
  VIEWLOOM_CHECK(
      message.SerializeToArray(const_cast<uint8_t*>(slice.begin()), static_cast<int>(byte_count)));
  return grpc::ByteBuffer(&slice, 1);
}

absl::Status parseMessage(grpc::ByteBuffer& bytes, google::protobuf::MessageLite& message) {
  const size_t byte_count = bytes.Length();
  grpc::ProtoBufferReader reader(&bytes);
  if (reader.status().ok() &&
      message.ParseFromBoundedZeroCopyStream(&reader, static_cast<int>(byte_count))) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      strCat("got ", byte_count, " bytes that are no ", message.GetTypeName()));
}

grpc::Slice sliceOf(const SharedBytes& bytes, size_t offset, size_t count) {
  VIEWLOOM_CHECK(offset + count <= bytes->size());
  const auto release = [](void* held) { delete static_cast<SharedBytes*>(held); };
  // gRPC asks for a mutable pointer but only reads through it.
  return grpc::Slice(const_cast<uint8_t*>(bytes->data() + offset), count, release,
                     new SharedBytes(bytes));
}

}  // namespace viewloom
