// SPDX-License-Identifier: Apache-2.0
#include "structure/cut_recording.h"

#include <algorithm>

namespace viewloom {
namespace {

// Bytes of a copy count as so many px of a pass.
constexpr uint64_t kCopiedBytesPerPx = 64;

}  // namespace

void recordCopy(CutRecording& recording, const Buffer& from, const Buffer& to,
                const CopiedBytes& bytes) {
  const uint64_t px_count = std::min(recording.piecePxCount(), bytes.size_bytes);
  const uint64_t piece_bytes = std::max<uint64_t>(px_count, 1) * kCopiedBytesPerPx;
  for (uint64_t done = 0; done < bytes.size_bytes; done += piece_bytes) {
    const uint64_t size_bytes = std::min(piece_bytes, bytes.size_bytes - done);
    recording.commands().copy(from, to,
                              {.from_offset = bytes.from_offset + done,
                               .to_offset = bytes.to_offset + done,
                               .size_bytes = size_bytes});
    recording.note(size_bytes / kCopiedBytesPerPx);
  }
}

}  // namespace viewloom
