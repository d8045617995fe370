// SPDX-License-Identifier: Apache-2.0
// Records the averaging of a source's colour for views with larger px, once a frame.
#pragma once

#include <compare>
#include <map>
#include <memory>
#include <mutex>

#include "gpu/commands.h"
#include "gpu/compute_pass.h"
#include "structure/structure_slot.h"

namespace viewloom {

// The device must outlive it. Thread-safety: all methods may be called from any thread.
class ColorAverager {
 public:
  explicit ColorAverager(const Device& device) : device_(&device) {}

  // Colour as a walk takes it.
  struct Color {
    const LayeredBuffer& texels;
    uint32_t format;  // abi::kColor...
  };
  // The planes of a structure, averaged over a reach. Records what makes them where that has not
  // been done since the upload: later submissions to the queue see it, too.
  Color record(Commands commands, const StructureSlot& structure, const ColorReach& reach);

 private:
  struct Variant {
    uint32_t reads_by_address;
    uint32_t writes_by_address;
    uint32_t format;
    uint32_t is_along_y;
    uint32_t tap_count;
    uint32_t strip_px;

    auto operator<=>(const Variant&) const = default;
  };
  struct Axis {
    bool is_y;
    float reach_px;
    const LayeredBuffer& from;
    uint32_t format;
    const LayeredBuffer& to;
  };

  void recordAlong(Commands commands, const StructureSlot& structure, const Axis& axis);
  const ComputePass& pass(const Variant& variant);

  const Device* device_;
  std::mutex mutex_;  // guards what follows, and the means of structures
  std::map<Variant, std::unique_ptr<ComputePass>> passes_;
};

}  // namespace viewloom
