// SPDX-License-Identifier: Apache-2.0
#include "walk/strip_traces.h"

#include <algorithm>
#include <bit>
#include <optional>

#include "engine/engine.h"

namespace viewloom {
namespace {

// Largest strip of which each picture may always have one: some 10 MB, with a lens or mirrors.
constexpr uint64_t kSmallStrip_px = uint64_t{1} << 18;

struct NoRoom {};

uint64_t pxOf(const TraceSlotShape& shape) {
  return uint64_t{shape.width_px} * shape.row_count_max;
}

}  // namespace

StripTraces::Kind StripTraces::kindOf(const TraceSlotShape& shape) {
  const TraceOutputs& outputs = shape.outputs;
  return {outputs.color, outputs.depth, outputs.mask, std::bit_width(pxOf(shape))};
}

StripTraces::Ring& StripTraces::ringOf(const TraceSlotShape& shape) {
  const auto [found, is_new] = rings_.try_emplace(
      kindOf(shape),
      Ring{.largest = {.outputs = shape.outputs}, .slots = {slot_count_, on_return_}});
  if (is_new) memory_.addIdle(found->second.slots.idleMemory());
  return found->second;
}

bool StripTraces::areSomeLent() const {
  return std::ranges::any_of(rings_,
                             [](const auto& ring) { return ring.second.slots.lentCount() > 0; });
}

std::unique_ptr<StripTrace> StripTraces::make(const TraceSlotShape& shape) {
  std::optional<Reservation> reserved = memory_.tryReserve(
      {.use = MemoryUse::kAtlases, .bytes = TraceSlot::hostBytesFor(device_, shape)});
  if (!reserved) throw NoRoom();
  return std::make_unique<StripTrace>(device_, shape, *std::move(reserved));
}

std::shared_ptr<StripTrace> StripTraces::take(const TraceSlotShape& shape,
                                              const AtlasOrder& order) {
  Ring& ring = ringOf(shape);
  if (ring.slots.isEmpty()) ring.largest = shape;
  ring.largest.include(shape);
  const bool is_small = pxOf(shape) <= kSmallStrip_px;
  try {
    return ring.slots.take(
        is_small ? order.picture_key : order.payer,
        [&](const StripTrace& free) { return free.slot.shape().holds(shape); },
        [&] { return make(ring.largest); });
  } catch (const NoRoom&) {
    if (areSomeLent()) return nullptr;
    throw EngineOutOfMemory(
        "the server's memory.budget has no room left to trace a display of this size; choose a "
        "smaller one, or try again later");
  }
}

}  // namespace viewloom
