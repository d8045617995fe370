// SPDX-License-Identifier: Apache-2.0
#include "sweep/atlas_pool.h"

#include <algorithm>
#include <optional>

namespace viewloom {

namespace {

// An atlas keeps the planes of other pictures, so that displays that take turns allocate nothing.
// One that keeps more than this is made anew, so that it gives the rest back.
uint64_t keptBytesMax(const TraceJob& picture, const TraceOutputs& outputs) {
  constexpr uint64_t kWasteFactorMax = 4;
  // RGBA, Y'CbCr in 4:4:4, depth and mask: whatever an encoding takes.
  constexpr uint64_t kEncodedPlanes_bytesPerPx = 4 + 3 + sizeof(float) + 1;
  return std::max(kWasteFactorMax * SweptAtlas().capacityBytesFor(picture, outputs),
                  kEncodedPlanes_bytesPerPx * picture.layout->size_px.area());
}

}  // namespace

bool HeldAtlas::fits(const TraceJob& picture, const TraceOutputs& outputs) const {
  return planes.capacityBytesFor(picture, outputs) <= memory.bytes() &&
         memory.bytes() <= keptBytesMax(picture, outputs);
}

bool HeldAtlas::makeRoom(MemoryBudget& budget, const TraceJob& picture,
                         const TraceOutputs& outputs) {
  if (fits(picture, outputs)) return true;
  const auto reserve = [&](uint64_t bytes) {
    memory.release();
    std::optional<Reservation> reserved =
        budget.tryReserve({.use = MemoryUse::kAtlases, .bytes = bytes});
    if (reserved) memory = *std::move(reserved);
    return reserved.has_value();
  };
  const uint64_t grown_bytes = planes.capacityBytesFor(picture, outputs);
  if (grown_bytes <= keptBytesMax(picture, outputs) && reserve(grown_bytes)) return true;
  planes = {};
  return reserve(SweptAtlas().capacityBytesFor(picture, outputs));
}

std::shared_ptr<HeldAtlas> AtlasPool::take(const std::string& key, const TraceJob& picture,
                                           const TraceOutputs& outputs) {
  if (aside_ && slots_.passOn(aside_, key)) return std::exchange(aside_, nullptr);
  return slots_.take(
      key, [&](const HeldAtlas& atlas) { return atlas.fits(picture, outputs); },
      [] { return std::make_unique<HeldAtlas>(); });
}

}  // namespace viewloom
