// SPDX-License-Identifier: Apache-2.0
// The GPU resources of one band in flight, and its px once they are traced.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "frame/stage_times.h"
#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/descriptor.h"
#include "picture/trace_job.h"
#include "shared/reflection_abi.h"
#include "shared/trace_abi.h"
#include "trace/readable_plane.h"
#include "trace/trace_params.h"
#include "trace/trace_slot_shape.h"
#include "trace/trace_slot_sizes.h"

namespace viewloom {

// Owner decides when the slot is free. Thread-safety: none.
class TraceSlot {
 public:
  TraceSlot(const Device& device, const TraceSlotShape& shape);

  const TraceSlotShape& shape() const { return shape_; }
  uint64_t sizeBytes() const;
  // The same of a slot of this shape, before it is made; of the CPU's memory alone.
  static uint64_t hostBytesFor(const Device& device, const TraceSlotShape& shape);

  // Once the band's submission is done. Rows from the top, packed.
  // Of the two forms of colour, the one that is not asked for is empty.
  std::span<const uint32_t> color() const;  // uint32_t[rows][width]: R, G, B, 255 in memory order
  std::span<uint32_t> mutableColor();
  std::span<float> mutableLinear();
  std::span<const uint8_t> ycbcr() const;  // as YcbcrLayout of the band
  std::span<const float> depth() const;    // float[rows][width], 1/m
  std::span<const uint8_t> mask() const;   // uint8_t[rows][width], RayClass
  std::span<const float> linear() const;   // float[rows][width][4], sRGB-encoded
  std::span<const abi::RayRecord> records() const;
  Coverage coverage() const;
  ReflectionCounts reflections() const;

  // For the passes over the slot's band:

  // Makes it the slot of this band: writes what its rays are told, and clears planes that they do
  // not fill. Later compute work sees it.
  void recordBegin(Commands commands, std::span<const StructureSlot* const> structures,
                   const TraceJob& job, BandRows rows);
  // Makes the planes readable, once colour has the form that is read.
  void recordReadback(Commands commands) const;

  SizePx bandSize_px() const { return band_px_; }
  const TraceParams& params() const { return params_; }
  // Where the walk stores colour.
  const Buffer& rgba() const { return isRgba() ? color_.target() : unpacked_; }
  // Where walks store colour of one sample of several.
  const Buffer& sampleTarget(const TraceJob& job) const {
    return job.sumsLight() ? sample_ : rgba();
  }
  const Buffer& colorTarget() const { return color_.target(); }
  const Buffer& counters() const { return counters_.target(); }
  uint64_t linearAddress() const { return linear_.address(); }
  const Buffer& answers() const { return answers_; }
  // Where one of several walks answers, at abi::kBindingBand.
  Descriptor answersOf(uint32_t walk, const AnswersLayout& layout) const;
  const Buffer& sums() const { return sums_; }
  const Buffer& met() const { return met_; }
  const Buffer& metLists() const { return met_lists_; }
  const Buffer& incomplete() const { return incomplete_; }
  const Buffer& unfinished() const { return unfinished_; }
  const Buffer& paths() const { return paths_; }
  const Buffer& reflected() const { return reflected_; }
  // Settings of a walk for the next submission.
  Descriptor writeReflectionSettings(uint32_t walk, const abi::ReflectionSettings& settings) const;

 private:
  bool isRgba() const { return shape_.outputs.color == ColorForm::kRgba; }
  // Address of abi::RayRecord per pixel; 0 = not wanted.
  uint64_t recordsAddress() const;
  TracedPlanes planes() const;
  uint64_t colorBytes() const;
  uint64_t rgbaCount() const { return isRgba() ? band_px_.area() : 0; }
  uint64_t linearCount() const { return band_px_.area() * 4; }
  // How often it stands at this place in the sets of counters.
  uint32_t counted(uint32_t place) const;

  TraceSlotShape shape_;
  SizePx band_px_;  // of the band in it
  ReadablePlane color_;
  Buffer unpacked_;  // RGBA of colour that is read back in another form
  ReadablePlane depth_;
  ReadablePlane mask_;
  ReadablePlane linear_;
  ReadablePlane records_;
  ReadablePlane counters_;
  TraceParams params_;
  Buffer answers_;  // abi::RayAnswer, of several walks
  Buffer sample_;   // RGBA of one of several samples
  Buffer sums_;     // light of those before it
  Buffer met_;      // what rays through a lens met
  Buffer met_lists_;
  Buffer incomplete_;  // abi::IncompleteHead
  Buffer unfinished_;  // the same, of runs; of a software device
  Buffer hits_;        // abi::RayRecord, where reflections begin; empty where records_ has them
  Buffer reflection_settings_;  // of each walk
  Buffer paths_;                // abi::ReflectedPath, of several walks
  Buffer reflected_;            // abi::ReflectedLight
};

}  // namespace viewloom
