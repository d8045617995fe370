// SPDX-License-Identifier: Apache-2.0
// Objects that the loops use and do not own. All of them outlive the pipeline.
#pragma once

#include <exception>
#include <functional>

#include "admission/memory_budget.h"
#include "base/clock.h"
#include "engine/engines.h"
#include "metrics/metrics.h"
#include "publish/broadcaster.h"
#include "publish/stream_directory.h"

namespace viewloom {

struct PipelineLinks {
  const Engines& engines;
  const Clock& clock;
  const Metrics& metrics;
  Broadcaster& broadcaster;
  StreamDirectory& directory;
  // A thread of the pipeline cannot go on (device lost); called once, from that
  // thread.
  std::function<void(const std::exception& error)> on_failure;
  MemoryBudget& memory = unboundedMemory();  // what waits for reuse is told to it
};

}  // namespace viewloom
