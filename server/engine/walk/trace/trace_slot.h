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
#include "shared/trace_abi.h"
#include "trace/trace_slot_shape.h"

namespace viewloom {

// A plane that kernels write and the CPU reads. On a device whose memory is the CPU's, one buffer;
// elsewhere a device buffer and the copy of it.
class ReadablePlane {
 public:
  ReadablePlane() = default;
  ReadablePlane(const Device& device, uint64_t size_bytes, const char* name);

  bool isEmpty() const { return readback_.sizeBytes() == 0; }
  const Buffer& target() const { return is_direct_ ? readback_ : device_only_; }
  // Makes what kernels wrote readable: a barrier, and a copy where one is needed.
  void recordReadback(Commands commands, uint64_t size_bytes) const;
  std::span<const std::byte> bytes() const { return readback_.mapped(); }
  std::span<std::byte> mutableBytes() { return readback_.mapped(); }

 private:
  Buffer device_only_;
  Buffer readback_;
  bool is_direct_ = true;
};

// Of rays by class, in sets (shaders/shared/trace_abi.h).
inline constexpr uint64_t kCounterCount = uint64_t{abi::kCounterSets} * abi::kCounterStride;

// What descriptors of any device may begin at.
inline constexpr uint64_t kDescriptorAlignment_bytes = 256;
inline constexpr uint64_t kExtrasStride_bytes = 2 * kDescriptorAlignment_bytes;
// What the answers of several walks take at most, unless a single row takes more: they are
// merged before the next rows are traced.
inline constexpr uint64_t kAnswersBytesMax = uint64_t{32} << 20;

// How the answers of several walks to a piece of a band lie in memory, walk after walk.
struct AnswersLayout {
  uint32_t row_count = 0;
  uint32_t stride = 0;  // answers from one walk to the next
};
AnswersLayout answersLayout(uint32_t width_px, uint32_t row_count, uint32_t walk_count);
// The same of reflected rays, where what is known of them takes its part of the memory.
AnswersLayout reflectedAnswersLayout(uint32_t width_px, uint32_t row_count, uint32_t walk_count);

// Owner decides when the slot is free. Thread-safety: none.
class TraceSlot {
 public:
  TraceSlot(const Device& device, const TraceSlotShape& shape);

  const TraceSlotShape& shape() const { return shape_; }
  uint64_t sizeBytes() const;

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

 private:
  friend class ViewTracer;

  // Of abi::RayRecord per px; 0 = not wanted.
  uint64_t recordsAddress() const;
  void addReflections(const Device& device, uint64_t area_px);
  // Of a walk; abi::ReflectionSettings.
  Descriptor reflectionDescriptor(uint32_t walk) const;
  uint64_t colorBytes() const;
  uint64_t rgbaCount() const {
    return shape_.outputs.color == ColorForm::kRgba ? band_px_.area() : 0;
  }
  uint64_t linearCount() const { return band_px_.area() * 4; }
  // How often it stands at this place in the sets of counters.
  uint32_t counted(uint32_t place) const;
  // Where the walk stores colour.
  const Buffer& rgba() const {
    return shape_.outputs.color == ColorForm::kRgba ? color_.target() : unpacked_;
  }
  // Where walks store colour of one sample of several.
  const Buffer& sampleTarget(const TraceJob& job) const {
    return job.sumsLight() ? sample_ : rgba();
  }
  // uint32_t[rows][width] of a sample.
  uint64_t metAddress(uint32_t sample) const {
    return met_.address() + sample * band_px_.area() * sizeof(uint32_t);
  }
  // Of each walk of each sample in the parameters: its abi::TraceExtras, and after all of those its
  // tiles. `part`: counts through the walks of the first sample, then of the next.
  static uint64_t extrasOffset(uint32_t part) { return part * kExtrasStride_bytes; }
  static uint64_t tilesOffset(uint32_t part, uint32_t part_count, size_t tile_count);
  // After all tiles, AtlasLayout::lens_points.
  static uint64_t lensOffset(const TraceJob& job);
  // Of a sample's point and those after it; without a lens, of nothing that is read.
  Descriptor lensDescriptor(const TraceJob& job, uint32_t sample) const;

  TraceSlotShape shape_;
  SizePx band_px_;  // of the band in it
  ReadablePlane color_;
  Buffer unpacked_;  // RGBA of colour that is read back in another form
  ReadablePlane depth_;
  ReadablePlane mask_;
  ReadablePlane linear_;
  ReadablePlane records_;
  ReadablePlane counters_;
  Buffer upload_;   // parameters
  Buffer params_;   // the same, on the device
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
