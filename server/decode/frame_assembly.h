// SPDX-License-Identifier: Apache-2.0
// Collects the chunks of one frame as they come over the wire, and refuses what does not follow on.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "admission/memory_budget.h"
#include "base/byte_pool.h"
#include "base/status.h"
#include "decode/arriving_plane.h"
#include "frame/frame.h"

namespace viewloom {

inline constexpr uint64_t kChunkBytesMax = uint64_t{1} << 20;

// A frame whose bytes have all come, as on the wire. Planes that became RGBA8 while they came
// (widensOnArrival() in frame/plane_encoding.h) are described as such.
struct CollectedFrame {
  FrameFormat format;
  std::vector<SharedBytes> planes;  // in the order of the wire: sources, layers, planes
  uint64_t session = 0;             // see FrameOrigin
  std::string publisher{};          // see Frame
  Reservation memory{};             // of the planes; goes on with the decoded frame
  int64_t arrival_ns = 0;           // CPU time of putting its chunks in place
};

// The declared planes in the order in which their chunks come.
std::vector<const PlaneFormat*> wirePlanes(const FrameFormat& format);

// Thread-safety: none; belongs to one call.
class FrameAssembly {
 public:
  // The format must have passed validateFrame. Memory for a plane is taken when its first chunk
  // comes. `memory`: of all planes, from now on (admission/frame_price.h).
  FrameAssembly(FrameFormat format, BytePool& pool, Reservation memory = {});

  // Before the next chunk: append() then brings all its bytes, in any pieces and on the same
  // thread, and nothing else may be called in between. Errors are INVALID_ARGUMENT and name
  // chunk.plane_index, chunk.offset_bytes or chunk.data; the assembly is of no use afterwards.
  absl::Status beginChunk(uint32_t plane_index, uint64_t offset_bytes, uint64_t size_bytes);
  void append(std::span<const uint8_t> bytes);
  // Both for a chunk at hand.
  absl::Status addChunk(uint32_t plane_index, uint64_t offset_bytes, std::string_view data);

  bool complete() const { return due_plane_ == declared_.size(); }
  // OK, or what is still missing: for a header that comes too early. Names the field "header".
  absl::Status requireComplete() const;
  uint64_t frameNumber() const { return format_.number; }

  // Expects complete(); call once.
  CollectedFrame take();

 private:
  uint64_t collectedBytes() const;  // of the plane that is due

  FrameFormat format_;
  BytePool& pool_;
  Reservation memory_;
  std::vector<const PlaneFormat*> declared_;  // in the order of the wire
  std::vector<SharedBytes> planes_;           // whole ones, until take()
  size_t due_plane_ = 0;                      // the one behind them
  std::optional<ArrivingPlane> arriving_;     // that one, from its first chunk on
  uint64_t awaited_bytes_ = 0;                // of the chunk that has begun
  int64_t chunk_begun_ns_ = 0;                // CPU time of its thread at that moment
  int64_t arrival_ns_ = 0;                    // CPU time of all chunks before it
};

}  // namespace viewloom
