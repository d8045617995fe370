// SPDX-License-Identifier: Apache-2.0
// Records what comes to the px of a band by way of surfaces that mirror.
#pragma once

#include <compare>
#include <map>
#include <memory>
#include <mutex>
#include <span>

#include "gpu/commands.h"
#include "gpu/compute_pass.h"
#include "picture/trace_job.h"
#include "structure/structure_slot.h"
#include "trace/albedos.h"

namespace viewloom {

// Rows of a band, and what is added to them.
struct ReflectedTarget {
  BandRows rows;
  const Buffer& reflected;      // abi::ReflectedLight per px
  const Buffer& rgba;           // changed
  uint64_t linear_address = 0;  // of TraceExtras::linear, changed too; 0 = not wanted
};

// Rows of a band of which each px is known: what it shows, and where its ray ended.
struct ReflectedRows {
  const StructureSlot& structure;  // whose shape mirrors
  const TraceJob& job;             // that reflects
  uint32_t row_count;
  abi::TracePush push;  // of the walk and these rows, with the structure's own colour
  // Of the walk: its tiles, its extras with the records, abi::ReflectionSettings, and the points of
  // the lens
  std::span<const Descriptor> params;
  const Buffer& reflected;  // abi::ReflectedLight per px of the band: that of the rows is written
};

// The device must outlive it. Thread-safety: all methods may be called from any thread.
class Reflector {
 public:
  explicit Reflector(const Device& device) : device_(&device), albedos_(device) {}

  // Of one source. Waits for the compute work before it; what follows may read what is written.
  void record(Commands commands, const ReflectedRows& rows);
  // Of light that is there; what follows may read the band.
  void recordAdd(Commands commands, const TraceJob& job, const ReflectedTarget& target);

 private:
  struct Variant {
    uint32_t reads_by_address;
    uint32_t color_format;
    uint32_t color_is_scaled;
    uint32_t rays;  // abi::kRaysOf...
    uint32_t through_lens;

    auto operator<=>(const Variant&) const = default;
  };

  const ComputePass& reflectPass(const Variant& variant);
  const ComputePass& addPass();

  const Device* device_;
  Albedos albedos_;
  std::mutex mutex_;  // guards what follows
  std::map<Variant, std::unique_ptr<ComputePass>> reflect_passes_;
  std::unique_ptr<ComputePass> add_pass_;
};

}  // namespace viewloom
