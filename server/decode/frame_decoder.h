// SPDX-License-Identifier: Apache-2.0
// From the bytes of the wire to an immutable Frame.
#pragma once

#include <memory>
#include <vector>

#include "base/byte_pool.h"
#include "base/status.h"
#include "decode/frame_assembly.h"
#include "decode/plane_decoder.h"
#include "frame/frame.h"

namespace viewloom {

// Result of each plane, in the order of the wire.
using DecodedPlanes = std::vector<absl::StatusOr<SharedBytes>>;

// The frame of these planes, or the first error among them, which then names the plane
// ("header.sources[0].layers[1].planes[0]").
absl::StatusOr<std::unique_ptr<Frame>> joinPlanes(FrameFormat format, DecodedPlanes planes,
                                                  BytePool& pool);

// Decodes one plane after the other. Thread-safety: none; one per thread.
class FrameDecoder {
 public:
  explicit FrameDecoder(BytePool& pool) : pool_(pool), planes_(pool) {}

  // Expects a format that validateFrame accepts. Errors as joinPlanes.
  absl::StatusOr<std::unique_ptr<Frame>> decode(CollectedFrame collected);

 private:
  BytePool& pool_;
  PlaneDecoder planes_;
};

}  // namespace viewloom
