// SPDX-License-Identifier: Apache-2.0
#include "pipeline/frame_builder.h"

#include <utility>

namespace viewloom {

ResidentStructure describe(const Frame& frame) {
  ResidentStructure structure;
  structure.frame_number = frame.format.number;
  structure.capture_time_ns = frame.format.capture_time_ns;
  structure.times = frame.times;
  for (const SourceFormat& source : frame.format.sources) {
    structure.sources.push_back(seenSource(source));
  }
  return structure;
}

bool FrameBuilder::isReadyFor(const Frame& frame, std::function<void()> then) const {
  const size_t engine = links_.engines.firstFor(frame);
  return links_.engines.all[engine]->isReadyFor(frame, std::move(then));
}

std::shared_ptr<FrameForms> FrameBuilder::takeSlot(SlotPool<FrameForms>& slots,
                                                   StreamPreparers& preparers,
                                                   const FramePtr& frame) const {
  std::shared_ptr<FrameForms> slot =
      slots.take([](const FrameForms&) { return true; },
                 [&] { return std::make_unique<FrameForms>(preparers); });
  if (slot) slot->take(frame, links_.engines);
  return slot;
}

void FrameBuilder::build(const Frame& frame, std::shared_ptr<FrameForms> slot,
                         const PreparationEvents& events, ResidentStructure& structure) const {
  const int64_t started_ns = links_.clock.nowNs();
  structure.upload_ns = slot->prepareFirst(links_.clock, events);
  structure.built_at_ns = links_.clock.nowNs();
  structure.build_ns = structure.built_at_ns - started_ns - structure.upload_ns;

  const FrameMeasures measures = slot->first().measures();
  structure.stats = measures.stats;
  structure.depths = measures.depths;
  for (const LayerPlanes& layer : frame.sources.front()) {
    structure.stats.bad_normals_count += layer.bad_normals_count;
    structure.stats.bad_motions_count += layer.bad_motions_count;
  }
  structure.forms = std::move(slot);
}

}  // namespace viewloom
