// SPDX-License-Identifier: Apache-2.0
#include "lib/frame_messages.h"

#include <algorithm>
#include <vector>

namespace viewloom {

bool takeFrameMessages(const WireFrame& frame, const TakeFrameMessage& take,
                       const std::function<size_t()>& chunk_bytes) {
  v1::PublishFramesRequest message;
  *message.mutable_header() = frame.header;
  if (!take(message)) return false;
  v1::FrameChunk& chunk = *message.mutable_chunk();
  for (size_t plane = 0; plane < frame.planes.size(); ++plane) {
    const std::vector<uint8_t>& bytes = *frame.planes[plane];
    for (size_t offset = 0; offset < bytes.size(); offset += chunk.data().size()) {
      const size_t size = std::min(chunk_bytes(), bytes.size() - offset);
      chunk.set_plane_index(static_cast<uint32_t>(plane));
      chunk.set_offset_bytes(offset);
      chunk.set_data(&bytes[offset], size);
      if (!take(message)) return false;
    }
  }
  return true;
}

}  // namespace viewloom
