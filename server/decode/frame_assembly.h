// SPDX-License-Identifier: Apache-2.0
// Collects the chunks of one frame as they come over the wire, and refuses what does not follow on.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "admission/memory_budget.h"
#include "base/byte_pool.h"
#include "base/status.h"
#include "frame/frame.h"

namespace viewloom {

inline constexpr uint64_t kChunkBytesMax = uint64_t{1} << 20;

// A frame whose bytes have all come, still as on the wire.
struct CollectedFrame {
  FrameFormat format;
  std::vector<SharedBytes> planes;  // in the order of the wire: sources, layers, planes
  uint64_t session = 0;             // see FrameOrigin
  std::string publisher{};          // see Frame
  Reservation memory{};             // of the planes; goes on with the decoded frame
};

// The declared planes in the order in which their chunks come.
std::vector<const PlaneFormat*> wirePlanes(const FrameFormat& format);

// Thread-safety: none; belongs to one call.
class FrameAssembly {
 public:
  // The format must have passed validateFrame. Memory for a plane is taken when its first chunk
  // comes. `memory`: of all planes, from now on (admission/frame_price.h).
  FrameAssembly(FrameFormat format, BytePool& pool, Reservation memory = {});

  // Where the next piece is to be written, whole, before endChunk(); nothing else may be called in
  // between. Errors are INVALID_ARGUMENT and name chunk.plane_index, chunk.offset_bytes or
  // chunk.data; the assembly is of no use afterwards.
  absl::StatusOr<std::span<uint8_t>> beginChunk(uint32_t plane_index, uint64_t offset_bytes,
                                                uint64_t size_bytes);
  void endChunk();
  // The same of a piece at hand.
  absl::Status addChunk(uint32_t plane_index, uint64_t offset_bytes, std::string_view data);

  bool complete() const { return current_plane_ == plane_bytes_.size(); }
  // OK, or what is still missing: for a header that comes too early. Names the field "header".
  absl::Status requireComplete() const;
  uint64_t frameNumber() const { return format_.number; }

  // Expects complete(); call once.
  CollectedFrame take();

 private:
  FrameFormat format_;
  BytePool& pool_;
  Reservation memory_;
  std::vector<uint64_t> plane_bytes_;  // declared, in wire order
  std::vector<SharedBytes> planes_;    // whole ones
  BytePool::Buffer filling_;           // of the current plane; null before its first chunk
  uint64_t collected_bytes_ = 0;       // of it
  uint64_t begun_bytes_ = 0;           // between beginChunk and endChunk
  size_t current_plane_ = 0;
};

}  // namespace viewloom
