// SPDX-License-Identifier: Apache-2.0
// From the bytes of the wire to an immutable Frame.
#pragma once

#include <memory>

#include "base/byte_pool.h"
#include "base/status.h"
#include "decode/frame_assembly.h"
#include "decode/jpeg_plane.h"
#include "decode/zstd_plane.h"
#include "frame/frame.h"

namespace viewloom {

// Planes come from the pool and return to it with the frame. Thread-safety: none; one per thread.
class FrameDecoder {
 public:
  explicit FrameDecoder(BytePool& pool) : pool_(pool) {}

  // Expects a format that validateFrame accepts. Errors are INVALID_ARGUMENT and name the plane
  // ("header.sources[0].layers[1].planes[0]").
  absl::StatusOr<std::unique_ptr<Frame>> decode(CollectedFrame collected);

 private:
  absl::StatusOr<SharedBytes> decodePlane(const PlaneFormat& plane, SharedBytes wire);
  absl::StatusOr<SharedBytes> inflatePlane(const PlaneFormat& plane, const SharedBytes& wire);

  BytePool& pool_;
  ZstdInflater zstd_;
  JpegDecoder jpeg_;
};

}  // namespace viewloom
