// SPDX-License-Identifier: Apache-2.0
// Reads a chunk off the wire to where the bytes of its plane go, without a copy in between.
#pragma once

#include <cstdint>
#include <optional>

#include <grpcpp/support/byte_buffer.h>

#include "base/status.h"
#include "decode/frame_assembly.h"

namespace viewloom {

// The bytes of a PublishFramesRequest that is a chunk and nothing else, with its data last: as
// every library of Protocol Buffers writes one. Nothing happens and nullopt comes back for other
// messages, which are to be parsed. Else how many bytes of data were taken, or why they were not,
// as FrameAssembly::beginChunk says it.
std::optional<absl::StatusOr<uint64_t>> readChunk(grpc::ByteBuffer& bytes, FrameAssembly& assembly);

}  // namespace viewloom
