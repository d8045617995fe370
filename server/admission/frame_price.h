// SPDX-License-Identifier: Apache-2.0
// Price of a frame in memory, by its header alone.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "admission/memory_budget.h"
#include "frame/frame.h"

namespace viewloom {

// Bytes of the planes of one frame on the host.
struct FramePrice {
  // From the header until the frame is decoded: wire, inflated and decoded bytes together.
  uint64_t receiving_bytes = 0;
  // Held as long as the decoded frame.
  uint64_t decoded_bytes = 0;
};

// Expects a format that validateFrame accepts.
FramePrice framePrice(const FrameFormat& format);

// Bytes that the server takes to prepare a frame of this format for rendering, beside its planes.
using PreparedBytes = std::function<uint64_t(const FrameFormat& format)>;

// Takes the frame into the budget, for the publisher `identity`, before a byte of it is received.
// The reservation is that of its planes; how it is prepared has to fit beside it. Errors are
// RESOURCE_EXHAUSTED, name the field "header", and say how large such a frame may be.
absl::StatusOr<Reservation> admitFrame(MemoryBudget& budget, const FrameFormat& format,
                                       const PreparedBytes& prepared_bytes,
                                       const std::string& identity);

}  // namespace viewloom
