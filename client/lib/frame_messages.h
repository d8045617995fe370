// SPDX-License-Identifier: Apache-2.0
// A frame as the messages of PublishFrames: its header, then its planes in chunks.
#pragma once

#include <grpcpp/support/byte_buffer.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "lib/wire_frame.h"

namespace viewloom {

// How large the next chunk may be, so that heartbeats are not held up by slow lines.
// A server hears of a message when all of it has come. Chunks begin small and grow while they go
// fast: on a line of 1 Mbit/s the largest would take 8 s. Thread-safety: none; one owner.
class ChunkSize {
 public:
  static constexpr size_t kMin_bytes = size_t{1} << 16;
  static constexpr size_t kMax_bytes = size_t{1} << 20;  // the most that a server takes

  size_t bytes() const { return bytes_; }
  // A chunk of this size has gone, in that time.
  void note(int64_t duration_ns) {
    if (duration_ns < kFast_ns) bytes_ = std::min(2 * bytes_, kMax_bytes);
    if (duration_ns > kSlow_ns) bytes_ = std::max(bytes_ / 2, kMin_bytes);
  }

 private:
  static constexpr int64_t kFast_ns = 100'000'000;
  static constexpr int64_t kSlow_ns = 400'000'000;

  size_t bytes_ = kMin_bytes;
};

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
