// SPDX-License-Identifier: Apache-2.0
// Makes small pictures that nobody sees, so that the kernels of likely displays are compiled before
// anybody waits for them.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "display/display_spec.h"
#include "gpu/submission.h"
#include "structure/frame_structure.h"
#include "trace/view_tracer.h"
#include "walk/walked_frame.h"

namespace viewloom {

// Thread-safety: none; one thread at a time.
class WarmUp {
 public:
  // All of it outlives it.
  WarmUp(StructureWorks& works, ViewTracer& tracer);

  // Makes the next piece and waits for it: the structure of a frame, or what needs a kernel or two
  // of a picture. False: all are made, or it is to stop, which it looks at between kernels.
  bool makeNext(const std::stop_token& stop);

 private:
  struct SmallPicture {
    DisplaySpec spec;
    TraceOutputs planes;
  };
  // One that is being traced, part by part.
  struct TracedPicture {
    TracedPicture(const Device& device, const FrameStructure& structure, TraceJob traced,
                  const TraceOutputs& wanted);

    const TraceJob job;
    const TraceOutputs planes;
    const BandRows rows;
    TraceSlot slot;
    BandParts parts;  // that are left
  };

  static std::vector<SmallPicture> likelyPictures();
  void tellEnd() const;
  void build();
  void begin(const SmallPicture& picture);
  bool compile(const std::stop_token& stop);
  void traceNext();
  void submit();

  StructureWorks& works_;
  ViewTracer& tracer_;
  CommandRecorder recorder_;
  const std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  std::vector<SmallPicture> left_;  // the next is the last
  std::vector<FramePtr> frames_;    // that are not built yet, likewise
  std::vector<SeenSource> sources_;
  std::unique_ptr<FrameStructure> structure_;  // of the last frame that was built
  std::optional<TracedPicture> current_;
};

}  // namespace viewloom
