// SPDX-License-Identifier: Apache-2.0
#include "sweep/swept_atlas.h"

#include <algorithm>

#include "shared/ycbcr.h"

namespace viewloom {
namespace {

bool hasUnusedPixels(const TraceJob& job) {
  const AtlasLayout& layout = *job.layout;
  return layout.padding_right_px > 0 || layout.padding_top_px > 0 ||
         layout.views.size() < size_t{layout.columns} * layout.rows;
}

// A vector that grows by itself may take twice what it needs, and keeps its old content.
void resizeExactly(size_t count, auto& plane) {
  if (plane.capacity() < count) {
    plane = {};
    plane.reserve(count);
  }
  plane.resize(count);
}

}  // namespace

void SweptAtlas::begin(const TraceJob& job, const TraceOutputs& outputs) {
  const size_t area_px = job.layout->size_px.area();
  const bool is_rgba = outputs.color == ColorForm::kRgba;
  const bool clears = hasUnusedPixels(job);
  const auto reset = [&](bool is_wanted, size_t count, auto value, auto& plane) {
    resizeExactly(is_wanted ? count : 0, plane);
    if (clears) std::fill(plane.begin(), plane.end(), value);
  };
  reset(is_rgba, area_px, kOpaqueBlack, color);
  reset(outputs.depth, area_px, 0.0F, depth);
  reset(outputs.mask, area_px, uint8_t{0}, mask);
  reset(outputs.linear, 4 * area_px, 0.0F, linear);
  reset(outputs.records, area_px, abi::RayRecord{}, records);
  if (is_rgba) return ycbcr.clear();
  const YcbcrLayout layout(job.layout->size_px, outputs.color);
  resizeExactly(layout.sizeBytes(), ycbcr);
  if (!clears) return;
  std::fill_n(ycbcr.begin(), layout.lumaBytes(), abi::lumaOf(0, 0, 0));
  static_assert(abi::cbOf(0, 0, 0) == abi::crOf(0, 0, 0));
  std::fill(ycbcr.begin() + ptrdiff_t(layout.cbOffset()), ycbcr.end(), abi::cbOf(0, 0, 0));
}

uint64_t SweptAtlas::capacityBytesFor(const TraceJob& job, const TraceOutputs& outputs) const {
  const SizePx size_px = job.layout->size_px;
  const uint64_t area_px = size_px.area();
  const bool is_rgba = outputs.color == ColorForm::kRgba;
  const uint64_t ycbcr_bytes = is_rgba ? 0 : YcbcrLayout(size_px, outputs.color).sizeBytes();
  const auto after = [](uint64_t capacity, uint64_t wanted, uint64_t sample_bytes) {
    return std::max(capacity, wanted) * sample_bytes;
  };
  return after(color.capacity(), is_rgba ? area_px : 0, sizeof(uint32_t)) +
         after(ycbcr.capacity(), ycbcr_bytes, 1) +
         after(depth.capacity(), outputs.depth ? area_px : 0, sizeof(float)) +
         after(mask.capacity(), outputs.mask ? area_px : 0, 1) +
         after(linear.capacity(), outputs.linear ? 4 * area_px : 0, sizeof(float)) +
         after(records.capacity(), outputs.records ? area_px : 0, sizeof(abi::RayRecord));
}

}  // namespace viewloom
