// SPDX-License-Identifier: Apache-2.0
// Adds reflected light to the pixels of a band, for surfaces of one source.
#pragma once

#include <compare>
#include <span>

#include "gpu/commands.h"
#include "gpu/compute_pass.h"
#include "gpu/pass_map.h"
#include "picture/trace_job.h"
#include "structure/structure_slot.h"
#include "trace/albedos.h"
#include "trace/band_rays.h"
#include "trace/trace_slot.h"

namespace viewloom {

// Rows of a band, and what is added to them.
struct ReflectedTarget {
  BandRows rows;
  const Buffer& reflected;      // abi::ReflectedLight per px
  const Buffer& rgba;           // changed
  uint64_t linear_address = 0;  // of TraceExtras::linear, changed too; 0 = not wanted
  RowSpan span;                 // rows of the band that get it
};

// Rows of a band, or columns of them, of which each px is known: what it shows, and where its ray
// ended.
struct ReflectedRows {
  const StructureSlot& structure;  // whose shape mirrors
  const TraceJob& job;             // that reflects
  uint32_t row_count;
  GroupColumns columns;  // of invocations, px by px
  abi::TracePush push;   // of the walk and these rows, with the structure's own colour
  // mirrorDescriptors() says which.
  std::span<const Descriptor> params;
  const Buffer& reflected;  // abi::ReflectedLight per px of the band: that of these px is written
};

// The device must outlive it. Thread-safety: all methods may be called from any thread.
class MirrorPass {
 public:
  explicit MirrorPass(const Device& device)
      : albedos_(device), reflect_passes_(device, makeReflectPass) {}

  // Kernels that record() needs.
  void addMissing(const StructureSlot& structure, const TraceJob& job, MissingKernels& missing);
  // Finds the light of these rows. Waits for the compute work before it; what follows may read what
  // is written.
  void record(Commands commands, const ReflectedRows& rows);
  // The same of a part of the slot's band.
  void record(Commands commands, const Walk& walk, BandRows rows, const BandPart& part,
              const TraceSlot& slot);

 private:
  struct Variant {
    uint32_t reads_by_address;
    uint32_t color_format;
    uint32_t color_is_scaled;
    uint32_t rays;  // abi::kRaysOf...
    uint32_t through_lens;

    auto operator<=>(const Variant&) const = default;
  };

  static ComputePass makeReflectPass(const Device& device, const Variant& variant);
  static Variant variantOf(const StructureSlot& structure, const TraceJob& job);

  Albedos albedos_;
  PassMap<Variant> reflect_passes_;
};

// Adds reflected light to px. The device must outlive it. Thread-safety: all methods may be called
// from any thread.
class MirroredLightPass {
 public:
  explicit MirroredLightPass(const Device& device) : pass_(device, makePass) {}

  // Kernels that record() needs.
  void addMissing(MissingKernels& missing) { pass_.addMissing({}, missing); }
  // The light is there; what follows may read the band.
  void record(Commands commands, const TraceJob& job, const ReflectedTarget& target);

 private:
  static ComputePass makePass(const Device& device, const std::monostate&);

  SinglePass pass_;
};

}  // namespace viewloom
