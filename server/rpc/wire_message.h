// SPDX-License-Identifier: Apache-2.0
// Messages ↔ the raw bytes that calls read and write.
#pragma once

#include <google/protobuf/message_lite.h>
#include <grpcpp/support/byte_buffer.h>

#include "base/byte_pool.h"
#include "base/status.h"

namespace viewloom {

grpc::ByteBuffer bytesFromMessage(const google::protobuf::MessageLite& message);

// Merges: what the message held stays where the bytes say nothing, so that its memory can be
// reused. INVALID_ARGUMENT for bytes that are no such message.
absl::Status mergeMessage(grpc::ByteBuffer& bytes, google::protobuf::MessageLite& message);

// The number of the field the bytes begin with; 0 when they begin with none.
uint32_t firstFieldNumber(grpc::ByteBuffer& bytes);

// Shares part of the bytes, without a copy; they stay alive as long as the slice does.
grpc::Slice sliceOf(const SharedBytes& bytes, size_t offset, size_t count);

}  // namespace viewloom
