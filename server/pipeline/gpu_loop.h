// SPDX-License-Identifier: Apache-2.0
// The one thread that records and submits GPU work, for the structure loop and the trace loop.
#pragma once

#include <atomic>
#include <deque>
#include <exception>
#include <future>
#include <mutex>
#include <thread>
#include <vector>

#include "gpu/timeline.h"
#include "pipeline/encode_pool.h"
#include "pipeline/structure_build.h"
#include "pipeline/trace_loop.h"
#include "pipeline/wake_up.h"
#include "structure/structure_builder.h"

namespace viewloom {

// Builds go before strips: everything traced afterwards is newer for it.
// Thread-safety: build() from any thread, stop() from one thread, once no build() is under way.
class GpuLoop {
 public:
  // `wake_up` is rung when there may be something to trace, or room for it.
  GpuLoop(const PipelineLinks& links, Timeline& timeline, const StructureBuilder& builder,
          TraceLoop& traces, WakeUp& wake_up);
  ~GpuLoop() { stop(); }

  // Builds the structure in an uploaded slot and waits until the device is done. Throws when the
  // loop has failed.
  void build(StructureBuild& build);
  // Finishes the atlases that have begun, and no others.
  void stop();
  // Ends at once, whatever has begun: the device is lost.
  void abandon();

 private:
  struct BuildRequest {
    StructureBuild* build;
    std::promise<uint64_t> timeline_value;
  };

  void run(const std::stop_token& stop);
  void end();
  bool submitBuild();

  const PipelineLinks& links_;
  Timeline& timeline_;
  const StructureBuilder& builder_;
  TraceLoop& traces_;
  WakeUp& wake_up_;
  std::atomic<bool> is_abandoned_ = false;
  std::mutex mutex_;
  std::deque<BuildRequest> builds_;
  bool has_ended_ = false;  // no build will be submitted any more
  std::jthread thread_;     // last: it uses all of the above
};

}  // namespace viewloom
