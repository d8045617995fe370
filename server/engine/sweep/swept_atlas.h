// SPDX-License-Identifier: Apache-2.0
// Memory that atlases are swept into.
#pragma once

#include <cstdint>

#include "base/untouched_vector.h"
#include "display/color_form.h"
#include "picture/trace_job.h"

namespace viewloom {

// A px that no view shows, as the atlas has it.
inline constexpr uint32_t kOpaqueBlack = 0xff000000;

// The planes of an atlas in host memory, packed, top row first. Those not wanted are empty; colour
// has one of two forms.
struct SweptAtlas {
  UntouchedVector<uint32_t> color;          // uint32_t[height][width]: R, G, B, 255 in memory order
  UntouchedVector<uint8_t> ycbcr;           // as YcbcrLayout
  UntouchedVector<float> depth;             // float[height][width], 1/Z of the view, 1/m
  UntouchedVector<uint8_t> mask;            // uint8_t[height][width], RayClass
  UntouchedVector<float> linear;            // float[height][width][4], sRGB-encoded
  UntouchedVector<abi::RayRecord> records;  // by px; no visits are counted

  // Room for the planes. Touches none of it: who sweeps rows writes all px of their views.
  void begin(const TraceJob& job, const TraceOutputs& outputs);
  // Makes px of these rows black that no view writes: beside views and where none stands. Px of
  // Y'CbCr are left that are written with those of views in their rows.
  void clearUnused(const TraceJob& job, const TraceOutputs& outputs, BandRows rows);

  // Bytes that it has room for after begin() of such an atlas.
  uint64_t capacityBytesFor(const TraceJob& job, const TraceOutputs& outputs) const;
};

}  // namespace viewloom
