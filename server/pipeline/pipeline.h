// SPDX-License-Identifier: Apache-2.0
// Frames in, atlases out: the structure loop and the trace loop with everything between them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "display/atlas_layout.h"
#include "frame/frame_sink.h"
#include "pipeline/pipeline_links.h"

namespace viewloom {

struct PipelineOptions {
  uint32_t encode_thread_count = 2;
  uint32_t structure_slots_per_stream = 2;  // >= 2: one is traced while the next is built
  uint32_t trace_slot_count = 3;            // strips on their way at once; swept atlases
  AtlasLimits atlas_limits;
};

// Memory is bounded by streams x structure_slots_per_stream and by trace_slot_count; frames of the
// same shape and displays of the same size reuse it. What builds alone need is shared by the slots
// of a stream.
// Thread-safety: all methods may be called from any thread.
class Pipeline final : public FrameSink {
 public:
  Pipeline(PipelineLinks links, const PipelineOptions& options);
  // Drains.
  ~Pipeline() override;

  void offerFrame(const FrameOrigin& origin, FramePtr frame, ReportFrame report) override;
  void forgetStream(const std::string& stream) override;

  // The displays of a stream changed: those without an atlas of its newest structure get one.
  void serveDisplays(const std::string& stream);

  // The eyes before a tracked display have moved: it is served from what is resident, once its last
  // atlas is done. However often, no more than one job waits. One that ticks is served when it
  // does.
  void serveEyes(const ActiveDisplay& display);

  // Takes no more frames, finishes and publishes the atlases that have begun, reports every frame.
  void drain();

 private:
  struct Loops;
  std::unique_ptr<Loops> loops_;
};

}  // namespace viewloom
