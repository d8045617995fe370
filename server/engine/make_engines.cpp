// SPDX-License-Identifier: Apache-2.0
#include "engine/make_engines.h"

#include "sweep/sweep_engine.h"
#include "walk/walk_engine.h"

namespace viewloom {

Engines makeEngines(const Device& device, const EngineOptions& options) {
  Engines engines{.all = {}, .workers = std::make_unique<WorkerPool>()};
  if (device.info().is_software) {
    engines.all.push_back(
        std::make_unique<SweepEngine>(options.trace_slot_count, *engines.workers, options.memory));
  }
  engines.all.push_back(
      std::make_unique<WalkEngine>(device, WalkOptions{.strip_count_max = options.trace_slot_count,
                                                       .warms_up = options.warms_up,
                                                       .memory = options.memory,
                                                       .compile_place = compilePlaceFor(device)}));
  return engines;
}

}  // namespace viewloom
