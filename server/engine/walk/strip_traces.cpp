// SPDX-License-Identifier: Apache-2.0
#include "walk/strip_traces.h"

#include <algorithm>
#include <optional>

#include "engine/engine.h"

namespace viewloom {
namespace {

struct NoRoom {};

}  // namespace

StripTraces::StripTraces(const Device& device, MemoryBudget& memory, uint32_t slot_count_max,
                         const std::function<void()>& on_return)
    : device_(device), memory_(memory) {
  for (const ColorForm color : {ColorForm::kRgba, ColorForm::kYcbcr444, ColorForm::kYcbcr420}) {
    for (const bool depth : {false, true}) {
      for (const bool mask : {false, true}) {
        for (const bool is_for_eyes : {false, true}) {
          rings_.push_back({is_for_eyes,
                            {.outputs = {.color = color, .depth = depth, .mask = mask}},
                            {slot_count_max, on_return}});
        }
      }
    }
  }
  for (const Ring& ring : rings_) memory_.addIdle(ring.slots.idleMemory());
}

bool StripTraces::areSomeLent() const {
  return std::ranges::any_of(rings_, [](const Ring& ring) { return ring.slots.lentCount() > 0; });
}

std::unique_ptr<StripTrace> StripTraces::make(const TraceSlotShape& shape) {
  std::optional<Reservation> reserved = memory_.tryReserve(
      {.use = MemoryUse::kAtlases, .bytes = TraceSlot::hostBytesFor(device_, shape)});
  if (!reserved) throw NoRoom();
  return std::make_unique<StripTrace>(device_, shape, *std::move(reserved));
}

std::shared_ptr<StripTrace> StripTraces::take(const TraceSlotShape& shape, bool is_for_eyes) {
  Ring& ring = *std::ranges::find_if(rings_, [&](const Ring& candidate) {
    return candidate.is_for_eyes == is_for_eyes && candidate.largest.outputs == shape.outputs;
  });
  if (ring.slots.isEmpty()) ring.largest = shape;
  ring.largest.include(shape);
  try {
    return ring.slots.take([&](const StripTrace& free) { return free.slot.shape().holds(shape); },
                           [&] { return make(ring.largest); });
  } catch (const NoRoom&) {
    if (areSomeLent()) return nullptr;
    throw EngineOutOfMemory(
        "the server's memory.budget has no room left to trace a display of this size; choose a "
        "smaller one, or try again later");
  }
}

}  // namespace viewloom
