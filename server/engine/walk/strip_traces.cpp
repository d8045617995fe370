// SPDX-License-Identifier: Apache-2.0
#include "walk/strip_traces.h"

#include <algorithm>

namespace viewloom {

StripTraces::StripTraces(const Device& device, uint32_t slot_count_max,
                         const std::function<void()>& on_return)
    : device_(device) {
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
}

std::shared_ptr<StripTrace> StripTraces::take(const TraceSlotShape& shape, bool is_for_eyes) {
  Ring& ring = *std::ranges::find_if(rings_, [&](const Ring& candidate) {
    return candidate.is_for_eyes == is_for_eyes && candidate.largest.outputs == shape.outputs;
  });
  ring.largest.include(shape);
  return ring.slots.take([&](const StripTrace& free) { return free.slot.shape().holds(shape); },
                         [&] { return std::make_unique<StripTrace>(device_, ring.largest); });
}

}  // namespace viewloom
