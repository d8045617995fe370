// SPDX-License-Identifier: Apache-2.0
// Splits a frame into the messages of PublishFrames: its header, then its planes in chunks.
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

// Size of the next chunk, so that slow connections do not delay heartbeats. A server notices a
// message only once all of it has arrived: the largest chunk takes 8 s at 1 Mbit/s. So chunks begin
// small and grow while they are sent fast. Thread-safety: none; one owner.
class ChunkSize {
 public:
  static constexpr size_t kMin_bytes = size_t{1} << 16;
  static constexpr size_t kMax_bytes = size_t{1} << 20;  // largest size that a server accepts

  size_t bytes() const { return bytes_; }
  // Notes how long it took to send a chunk of this size.
  void note(int64_t duration_ns) {
    if (duration_ns < kFast_ns) bytes_ = std::min(2 * bytes_, kMax_bytes);
    if (duration_ns > kSlow_ns) bytes_ = std::max(bytes_ / 2, kMin_bytes);
  }

 private:
  static constexpr int64_t kFast_ns = 100'000'000;
  static constexpr int64_t kSlow_ns = 400'000'000;

  size_t bytes_ = kMin_bytes;
};

// One serialised message: `head`, then `data`. A chunk shares the bytes of its plane and copies
// none. The plane lives as long as the message.
struct FrameMessage {
  std::string head;
  SharedBytes plane;              // null for a header, which has no data
  std::span<const uint8_t> data;  // within the plane
};

// Returns the message for gRPC. gRPC keeps the plane alive while it uses the bytes, even after the
// end of the call.
grpc::ByteBuffer bytesOf(const FrameMessage& message);

// Takes one message; returns false to stop.
using TakeFrameMessage = std::function<bool(const FrameMessage&)>;

// Gives all messages of a frame to `take`, in the order of the wire. `chunk_bytes` is called for
// the size of each chunk. Returns true if `take` took all of them.
bool takeFrameMessages(
    const WireFrame& frame, const TakeFrameMessage& take,
    const std::function<size_t()>& chunk_bytes = [] { return ChunkSize::kMax_bytes; });

}  // namespace viewloom
