// SPDX-License-Identifier: Apache-2.0
#include "bench/memory_use.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "gpu/submission.h"
#include "structure/frame_structure.h"
#include "structure/structure_builder.h"
#include "support/heap_meter.h"
#include "sweep/sweep_source.h"
#include "sweep/view_sweeper.h"
#include "trace/view_tracer.h"
#include "walk/strip_traces.h"

namespace viewloom::bench {
namespace {

// With planes of its own, as one that was decoded.
FramePtr decodedCopy(const Frame& frame) {
  auto copy = std::make_shared<Frame>(frame);
  for (std::vector<LayerPlanes>& layers : copy->sources) {
    for (LayerPlanes& planes : layers) {
      planes.color = std::make_shared<std::vector<uint8_t>>(*planes.color);
      planes.depth = std::make_shared<std::vector<uint8_t>>(*planes.depth);
    }
  }
  return copy;
}

uint64_t planeBytes(const Frame& frame) {
  uint64_t total_bytes = 0;
  for (const LayerPlanes& planes : frame.sources.front()) {
    total_bytes += planes.color->capacity() + planes.depth->capacity();
  }
  return total_bytes;
}

TraceSlotShape stripShape(const TraceJob& job) {
  const SizePx atlas_px = job.layout->size_px;
  return {.width_px = atlas_px.width,
          .row_count_max = std::min(bandRowCount(EncodingSpec{}), atlas_px.height),
          .tile_count_max = uint32_t(job.tiles.size())};
}

// A frame on the device, with the commands that build it.
struct WalkedForm {
  WalkedForm(const Device& device, const FrameBuildMemory& build_memory)
      : structure(device, build_memory), recorder(device) {}

  FrameStructure structure;
  CommandRecorder recorder;
};

// The walk's share of the server, with slots of its own for one frame.
class Walk {
 public:
  Walk(const Device& device, const TraceJob& job)
      : device_(device), job_(job), timeline_(device), builder_(device), tracer_(device) {}

  MemoryUse serve(const Frame& frame) {
    const test::HeapMeter heap;
    MemoryUse use;
    const FramePtr input = decodedCopy(frame);
    use.frame_input_bytes = planeBytes(*input);
    const uint64_t before_bytes = gpuMemoryBytes();
    const FrameBuildMemory build_memory = makeBuildMemory(device_, shapesOf(*input));
    WalkedForm form(device_, build_memory);
    const uint64_t form_bytes = gpuMemoryBytes() - before_bytes;
    StripTrace strip(device_, stripShape(job_), Reservation());
    use.trace_target_bytes = gpuMemoryBytes() - before_bytes - form_bytes;
    build(*input, form);
    trace(form, strip);
    // With what the first display has made of it.
    const uint64_t held_bytes = gpuMemoryBytes() - before_bytes;
    use.structure_bytes = held_bytes - use.trace_target_bytes;
    if (test::HeapMeter::isAvailable()) {
      // The memory of a software device lies in the heap.
      const uint64_t device_bytes = device_.info().is_software ? 0 : held_bytes;
      use.peak_bytes = uint64_t(heap.peakBytes()) + device_bytes;
    }
    WalkedForm further_form(device_, build_memory);
    StripTrace further_strip(device_, stripShape(job_), Reservation());
    build(*input, further_form);
    trace(further_form, further_strip);
    use.further_frame_bytes = gpuMemoryBytes() - before_bytes - held_bytes;
    return use;
  }

 private:
  void build(const Frame& frame, WalkedForm& form) {
    form.structure.upload(frame);
    form.structure.recordBuild(form.recorder.begin(), builder_);
    timeline_.wait(form.recorder.submit(timeline_));
  }

  // The first strip: all others go through the same slot.
  void trace(const WalkedForm& form, StripTrace& strip) {
    tracer_.recordBand(strip.recorders[0].begin(), form.structure.firstPart(), job_,
                       {0, strip.slot.shape().row_count_max}, strip.slot, nullptr);
    timeline_.wait(strip.recorders[0].submit(timeline_));
  }

  const Device& device_;
  const TraceJob& job_;
  Timeline timeline_;
  StructureBuilder builder_;
  ViewTracer tracer_;
};

// A frame that is swept, and its atlas.
struct SweptFrame {
  SweepSource source;
  SweptAtlas atlas;
};

}  // namespace

MemoryUse walkMemory(const Device& device, const Frame& frame, const TraceJob& job) {
  Walk walk(device, job);
  walk.serve(frame);
  return walk.serve(frame);
}

bool canMeasureSweeps() {
  return test::HeapMeter::isAvailable();
}

MemoryUse sweepMemory(const Frame& frame, const TraceJob& job, const SweepPlan& plan,
                      WorkerPool& workers) {
  const test::HeapMeter heap;
  std::vector<ViewSweeper> sweepers;
  SweptFrame first;
  SweptFrame further;
  const auto prepare = [&](SweptFrame& swept) {
    swept.source.prepare(decodedCopy(frame), workers);
  };
  const TraceOutputs outputs{.color = plan.colorForm(directForm(EncodingSpec{}))};
  const auto sweep = [&](SweptFrame& swept) {
    sweepAtlas({.job = &job,
                .plan = &plan,
                .source = swept.source.rowSource(),
                .inv_z_max = float(swept.source.measured().stats.inv_z_max)},
               outputs, workers, sweepers, swept.atlas);
  };
  MemoryUse use;
  use.frame_input_bytes = planeBytes(frame);
  prepare(first);
  use.structure_bytes = uint64_t(heap.grownBytes()) - use.frame_input_bytes;
  sweep(first);
  const auto held_bytes = uint64_t(heap.grownBytes());
  use.trace_target_bytes = held_bytes - use.structure_bytes - use.frame_input_bytes;
  use.peak_bytes = uint64_t(heap.peakBytes());
  prepare(further);
  sweep(further);
  use.further_frame_bytes = uint64_t(heap.grownBytes()) - held_bytes;
  return use;
}

}  // namespace viewloom::bench
