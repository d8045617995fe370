// SPDX-License-Identifier: Apache-2.0
// From the bytes of one plane on the wire to what a Frame holds.
#pragma once

#include "base/byte_pool.h"
#include "base/status.h"
#include "decode/jpeg_plane.h"
#include "decode/zstd_plane.h"
#include "frame/frame.h"

namespace viewloom {

// Planes come from the pool and return to it with the last reader. Thread-safety: none; one per
// thread.
class PlaneDecoder {
 public:
  explicit PlaneDecoder(BytePool& pool) : pool_(pool) {}

  // Expects a plane of a format that validateFrame accepts. Errors are INVALID_ARGUMENT, without a
  // field. Planes that need no work are handed on as they are.
  absl::StatusOr<SharedBytes> decode(const PlaneFormat& plane, SharedBytes wire);

 private:
  absl::StatusOr<SharedBytes> inflate(const PlaneFormat& plane, const SharedBytes& wire);

  BytePool& pool_;  // decoders write whole buffers, which need not be cleared before
  ZstdInflater zstd_;
  JpegDecoder jpeg_;
};

}  // namespace viewloom
