// SPDX-License-Identifier: Apache-2.0
// A view of a frame whose surfaces mirror, traced as far as its own rays go: what finds the light
// that mirrors show is run over it, again and again.
#pragma once

#include <functional>
#include <vector>

#include "gpu/commands.h"
#include "gpu/submission.h"
#include "structure/frame_structure.h"
#include "trace/mirror_pass.h"
#include "trace/view_tracer.h"

namespace viewloom {

// Compiled once for many stages. The device must outlive them.
struct MirrorKernels {
  explicit MirrorKernels(const Device& of)
      : device(of), builder(of), tracer(of), mirror(of), mirrored_light(of) {}

  const Device& device;
  StructureBuilder builder;
  ViewTracer tracer;
  MirrorPass mirror;
  MirroredLightPass mirrored_light;
};

// Reflections of one source. Thread-safety: none.
class MirrorStage {
 public:
  // `display`: complete, and asks for reflections. Throws what cannot be shown. The kernels must
  // outlive it.
  MirrorStage(MirrorKernels& kernels, const Frame& frame, const DisplaySpec& display);

  const AtlasLayout& layout() const { return *job_.layout; }
  SourceStats stats() const { return structure_.stats().front(); }
  // Where the view's own rays ended: [height][width].
  const std::vector<abi::RayRecord>& records() const { return own_records_; }

  // By how much errors of what is mirrored may move the picture from here on, px; at first as the
  // display says.
  void setTolerance(double tolerance_px);

  // Finds the light of all px. Returns how long that took, from its submission to its end.
  using Record = std::function<void(Commands, const ReflectedRows&)>;
  double timedMs(const Record& record);

  // float[height][width][4], sRGB-encoded: the view without its mirrors' light, and with what was
  // found last.
  const std::vector<float>& without() const { return without_; }
  std::vector<float> picture();

 private:
  abi::TracePush push() const;
  void build(const Frame& frame);
  void traceOwnRays();
  void describe();
  Buffer filled(const void* from, uint64_t size_bytes, MemoryIntent intent, const char* name);

  MirrorKernels& kernels_;
  const Device& device_;
  Timeline timeline_;
  CommandRecorder recorder_;
  FrameStructure structure_;
  TraceJob job_;
  std::vector<float> without_;
  std::vector<abi::RayRecord> own_records_;
  Buffer records_;
  Buffer counters_;
  Buffer views_;
  Buffer extras_;
  Buffer settings_;
  Buffer reflected_;
  Buffer rgba_;
  ReadablePlane linear_;
  std::vector<Descriptor> params_;
};

}  // namespace viewloom
