// SPDX-License-Identifier: Apache-2.0
// Price of an open display and of each of its viewers in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "admission/memory_budget.h"
#include "base/send_queue.h"
#include "display/display_spec.h"

namespace viewloom {

// Bytes. Sizes of JPEG are estimates for photographs: half a byte a pixel, or one from a quality of
// 91 on. All others are upper bounds.
struct DisplayPrice {
  uint64_t rays_bytes = 0;     // where each view and each sample of its pixels lies
  uint64_t encoded_bytes = 0;  // one atlas as it is sent
  uint64_t making_bytes = 0;   // planes of one atlas while it is made
  uint64_t chain_bytes = 0;    // encoders that chained video keeps from atlas to atlas
  uint64_t queue_bytes = 0;    // atlases of chained video that wait for one viewer

  // Held while it is open: its rays, its newest atlas, the one that follows, and its encoders.
  uint64_t displayBytes() const { return rays_bytes + 2 * encoded_bytes + chain_bytes; }
  // A slow viewer is still sent an older atlas, and others may wait; its call has buffers.
  uint64_t viewerBytes() const;
};

// Atlases of chained video that wait for one viewer: two, however large they are, or so many, of so
// many bytes together.
inline constexpr size_t kQueuedAtlasesMin = 2;
inline constexpr size_t kQueuedAtlasesMax = 16;
inline constexpr uint64_t kQueuedBytesMax = uint64_t{1} << 20;

// Expects a completed spec, as all functions here.
uint64_t atlasPixels(const DisplaySpec& spec);
// Pictures a second of a display, whose stream has so many frames a second.
double pictureRate(const DisplaySpec& spec, double stream_rate_hz);
DisplayPrice displayPrice(const DisplaySpec& spec, const EncodingSpec& encoding);

// Takes a display into the budget before it is opened, for the viewer `identity`. An atlas has to
// fit beside it while it is made. Errors are RESOURCE_EXHAUSTED, name the field of the display that
// makes it smaller, and say how large such an atlas may be.
absl::StatusOr<Reservation> admitDisplay(MemoryBudget& budget, const DisplaySpec& spec,
                                         const EncodingSpec& encoding, const std::string& identity);
// The same of another viewer of an open display. Names no field.
absl::StatusOr<Reservation> admitViewer(MemoryBudget& budget, const DisplaySpec& spec,
                                        const EncodingSpec& encoding, const std::string& identity);

// A connection whatever it asks for, and a publisher's call: its buffers here, and what the kernel
// holds of it. An idle gRPC connection takes 13 to 21 kB of the heap (2026-11-27).
inline constexpr uint64_t kConnectionBytes = (uint64_t{64} << 10) + kSendQueueBytes;
// An open gRPC call, whatever it asks for: 18 to 20 kB of the heap, and 28 kB with metadata of 7 kB
// (600 calls that say nothing, gRPC 1.51 on x86-64, 2026-11-27).
inline constexpr uint64_t kOpenCallBytes = uint64_t{32} << 10;

}  // namespace viewloom
