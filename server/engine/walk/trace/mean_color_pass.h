// SPDX-License-Identifier: Apache-2.0
// Records the averaging of a source's colour for views with larger px, once a frame.
#pragma once

#include <array>
#include <compare>
#include <mutex>

#include "gpu/commands.h"
#include "gpu/pass_map.h"
#include "structure/structure_slot.h"

namespace viewloom {

// The device must outlive it. Thread-safety: all methods may be called from any thread.
class MeanColorPass {
 public:
  explicit MeanColorPass(const Device& device) : device_(device), passes_(device, makePass) {}

  // How a walk takes colour that is averaged over a reach: abi::kColor...
  static uint32_t formatOf(const StructureSlot& structure, const ColorReach& reach);
  // Kernels that record() needs.
  void addMissing(const StructureSlot& structure, const ColorReach& reach, MissingKernels& missing);

  // Colour as a walk takes it.
  struct Color {
    const LayeredBuffer& texels;
    uint32_t format;  // abi::kColor...
  };
  // The planes of a structure, averaged over a reach. Records what makes them where that has not
  // been done since the upload: later submissions to the queue see it, too.
  Color record(Commands commands, const StructureSlot& structure, const ColorReach& reach);
  // Records the next rows of that, of about so many texels. Returns how many; 0 = all is made.
  uint64_t recordRows(Commands commands, const StructureSlot& structure, const ColorReach& reach,
                      uint64_t texel_count_max);

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
  // The planes that are averaged come in `format`.
  struct Axis {
    bool is_y;
    float reach_px;
    uint32_t format;
  };
  struct Average {
    Axis axis;
    const ComputePass& pass;
  };
  using Averages = std::array<Average, 2>;  // along y, then along x

  static ComputePass makePass(const Device& device, const Variant& variant);
  static std::array<Axis, 2> axesOf(const StructureSlot& structure, const ColorReach& reach);
  Averages averagesOf(const StructureSlot& structure, const ColorReach& reach);
  Variant variantOf(const StructureSlot& structure, const Axis& axis) const;
  uint32_t stripPx(const StructureSlot& structure) const;
  // A mean along x takes means along y of its own row alone: rows are made one after the other.
  void recordMeans(Commands commands, const StructureSlot& structure, const Averages& averages,
                   uint32_t row_count, MeanColor::Planes& planes);
  struct Rows {
    uint32_t first = 0;
    uint32_t count = 0;
  };
  void recordAlong(Commands commands, const StructureSlot& structure, const Average& average,
                   Rows rows, const LayeredBuffer& from, const LayeredBuffer& to);

  const Device& device_;
  PassMap<Variant> passes_;
  std::mutex mutex_;  // guards the means of structures
};

}  // namespace viewloom
