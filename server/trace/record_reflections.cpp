// SPDX-License-Identifier: Apache-2.0
#include "trace/view_tracer.h"

namespace viewloom {

void ViewTracer::recordReflections(vk::CommandBuffer commands, const Walk& walk, BandRows rows) {
  const std::vector<Descriptor> params =
      describeParams(walk.job, walk.index, walk.rays.sample, walk.slot);
  // The mean of several samples is made of their codes.
  const bool shows_linear = !walk.slot.linear_.isEmpty() && walk.job.sample_count == 1;
  reflector_.record(commands,
                    {.structure = walk.structure,
                     .job = walk.job,
                     .rows = rows,
                     .push = describeBand(walk, walk.structure.color(), rows),
                     .params = params,
                     .settings = walk.slot.reflection_settings_,
                     .reflected = walk.slot.reflected_,
                     .rgba = walk.slot.sampleTarget(walk.job),
                     .linear_address = shows_linear ? walk.slot.linear_.target().address() : 0});
}

}  // namespace viewloom
