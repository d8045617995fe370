// SPDX-License-Identifier: Apache-2.0
// Converts between messages and the raw bytes that calls read and write.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <google/protobuf/message_lite.h>
#include <grpcpp/support/byte_buffer.h>

#include "base/byte_pool.h"
#include "base/status.h"

namespace viewloom {

grpc::ByteBuffer bytesFromMessage(const google::protobuf::MessageLite& message);

// Parses a message of at most bytes_max. INVALID_ARGUMENT for more, and for bytes that are not such
// a message. Two bytes of a message may take a hundred in memory, before anybody can count the
// elements, so each caller says how much its largest honest message has.
absl::Status parseMessage(grpc::ByteBuffer& bytes, google::protobuf::MessageLite& message,
                          size_t bytes_max = SIZE_MAX);

// Shares part of the bytes without a copy. They live as long as the slice.
grpc::Slice sliceOf(const SharedBytes& bytes, size_t offset, size_t count);

// Number of the field that holds a part, and of the bytes field inside the part. The second one has
// the highest number, so that its bytes end the message.
struct DataFields {
  int part = 0;
  int data = 0;
};

// Beginning of a serialised message up to its data, which follow without a copy.
std::string headOfMessage(const google::protobuf::MessageLite& part_without_data, DataFields fields,
                          size_t data_bytes);

}  // namespace viewloom
