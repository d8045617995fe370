// SPDX-License-Identifier: Apache-2.0
// A frame as the messages of PublishFrames: its header, then its planes in chunks.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include <grpcpp/support/byte_buffer.h>

#include "lib/chunk_size.h"
#include "lib/wire_frame.h"

namespace viewloom {

// One serialised message: `head`, then `data`. A chunk shares the bytes of its plane: none is
// copied on the way to the network, and the plane lives as long as the message.
struct FrameMessage {
  std::string head;
  SharedBytes plane;              // null for a header, which has no data
  std::span<const uint8_t> data;  // within the plane
};

// The same bytes for gRPC, which keeps the plane alive until it has let go of them, even after the
// end of the call.
grpc::ByteBuffer bytesOf(const FrameMessage& message);

// False = no further message is wanted.
using TakeFrameMessage = std::function<bool(const FrameMessage&)>;

// In the order of the wire, chunks as large as `chunk_bytes` says before each of them. True when
// `take` took all.
bool takeFrameMessages(
    const WireFrame& frame, const TakeFrameMessage& take,
    const std::function<size_t()>& chunk_bytes = [] { return ChunkSize::kMax_bytes; });

}  // namespace viewloom
