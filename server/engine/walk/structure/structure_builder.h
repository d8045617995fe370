// SPDX-License-Identifier: Apache-2.0
// Records the build of a structure: colour, columns, tolerance, facets, links, pyramid.
#pragma once

#include <span>
#include <vector>

#include "gpu/commands.h"
#include "gpu/gpu_timer.h"
#include "gpu/pass_map.h"
#include "structure/cut_recording.h"
#include "structure/structure_passes.h"
#include "structure/structure_slot.h"

namespace viewloom {

// Passes a recording times at most.
inline constexpr uint32_t kStructurePassCountMax = 16;

// The device must outlive it. Thread-safety: all methods may be called from any thread. The first
// recording of a variant makes its pipelines, unless they were compiled beforehand.
class StructureBuilder {
 public:
  explicit StructureBuilder(const Device& device);

  // Adds the kernels of a build of this frame that nobody has compiled.
  void addMissing(const Frame& frame, MissingKernels& missing) const;
  // The same of frames that are likely to come, the likeliest first: pictures that fit into
  // bindings.
  std::vector<MissingKernels> likelyKernels() const;

  // From uploaded planes to a structure that can be traced, and its stats in host memory. Commands
  // recorded afterwards in the same submission see it, too. `timer` was reset in this recording;
  // nullptr = untimed.
  void record(Commands commands, const StructureSlot& slot, GpuTimer* timer) const;
  // The same, in several submissions if wanted.
  void record(CutRecording& cuts, const StructureSlot& slot) const;
  // The same for the six faces of a cube map, whose aprons come from each other. `face_list`:
  // abi::CubeFaceList of them.
  void recordCube(CutRecording& cuts, std::span<const StructureSlot* const> faces,
                  const Buffer& face_list) const;

 private:
  void addMissing(const PrepareVariant& variant, MissingKernels& missing) const;
  // From uploaded planes to columns as they are kept.
  void recordColumns(CutRecording& cuts, const StructureSlot& slot, GpuTimer* timer) const;
  // From those to what can be traced, and its stats in host memory.
  void recordSurfaces(CutRecording& cuts, const StructureSlot& slot, GpuTimer* timer) const;
  void recordColor(CutRecording& cuts, const StructureSlot& slot) const;

  const Device& device_;
  ComputePass convert_color_;
  mutable PassMap<StructureVariant, StructurePasses> passes_;
  mutable PassMap<PrepareVariant> preparations_;
  mutable PassMap<std::monostate, ApronPasses> apron_passes_;
};

}  // namespace viewloom
