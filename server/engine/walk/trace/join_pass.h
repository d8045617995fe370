// SPDX-License-Identifier: Apache-2.0
// Makes one answer of those of the faces of a cube map.
#pragma once

#include "gpu/commands.h"
#include "gpu/pass_map.h"
#include "picture/trace_job.h"
#include "trace/trace_slot.h"

namespace viewloom {

// The device must outlive it. Thread-safety: all methods may be called from any thread.
class JoinPass {
 public:
  explicit JoinPass(const Device& device) : pass_(device, makePass) {}

  // Kernels that record() needs.
  void addMissing(const TraceJob& job, MissingKernels& missing);
  // For each cube map of the job one answer, in the place of its first face's. `walked`: the walks
  // that have answered these rays, a bit each. Waits for no compute work before it; work after it
  // waits.
  void record(Commands commands, const TraceJob& job, uint64_t walked, AnswerSpan span,
              const AnswersLayout& answers, const TraceSlot& slot);

 private:
  static ComputePass makePass(const Device& device, const std::monostate&);

  SinglePass pass_;
};

}  // namespace viewloom
