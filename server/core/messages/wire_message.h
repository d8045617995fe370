// SPDX-License-Identifier: Apache-2.0
// Messages ↔ the raw bytes that calls read and write.
#pragma once

#include <cstddef>
#include <string>

#include <google/protobuf/message_lite.h>
#include <grpcpp/support/byte_buffer.h>

#include "base/byte_pool.h"
#include "base/status.h"

namespace viewloom {

grpc::ByteBuffer bytesFromMessage(const google::protobuf::MessageLite& message);

// INVALID_ARGUMENT for bytes that are no such message.
absl::Status parseMessage(grpc::ByteBuffer& bytes, google::protobuf::MessageLite& message);

// Shares part of the bytes, without a copy; they stay alive as long as the slice does.
grpc::Slice sliceOf(const SharedBytes& bytes, size_t offset, size_t count);

// The field of a message that holds a part, and the bytes field of that part: its highest one, so
// that its bytes end the message.
struct DataFields {
  int part = 0;
  int data = 0;
};

// The beginning of a serialised message, up to the data, which are sent behind it without a copy.
std::string headOfMessage(const google::protobuf::MessageLite& part_without_data, DataFields fields,
                          size_t data_bytes);

}  // namespace viewloom
