// SPDX-License-Identifier: Apache-2.0
// Messages ↔ the raw bytes that calls read and write.
#pragma once

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

}  // namespace viewloom
