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

// Calls clear(first px, count) for runs of px in a row of the atlas that no view writes.
void forEachUnusedRun(const TraceJob& job, uint32_t row, const auto& clear) {
  const AtlasLayout& layout = *job.layout;
  const size_t first_px = size_t{row} * layout.size_px.width;
  if (row < layout.padding_top_px) return clear(first_px, layout.size_px.width);
  const uint32_t grid_row = (row - layout.padding_top_px) / layout.tile_size_px.height;
  const auto tiles = job.tilesOf(0).subspan(size_t{grid_row} * layout.columns, layout.columns);
  for (uint32_t column = 0; column < layout.columns; ++column) {
    if (tiles[column].is_used != 0) continue;
    clear(first_px + size_t{column} * layout.tile_size_px.width, layout.tile_size_px.width);
  }
  const uint32_t end_px = layout.columns * layout.tile_size_px.width;
  if (end_px < layout.size_px.width) clear(first_px + end_px, layout.size_px.width - end_px);
}

// Rows of the atlas above all views.
void clearAbove(const AtlasLayout& layout, ColorForm form, BandRows rows, uint8_t* planes) {
  const YcbcrLayout at(layout.size_px, form);
  const uint32_t shared_px = form == ColorForm::kYcbcr420 ? 2 : 1;  // rows a chroma sample
  // A row that shares chroma with the first one of a view is written with it.
  const uint32_t end_row = layout.padding_top_px / shared_px * shared_px;
  const auto fillRows = [&](size_t offset, size_t stride, uint32_t rows_a_sample, uint8_t code) {
    const auto sampleRow = [&](uint32_t row) {
      return (std::min(row, end_row) + rows_a_sample - 1) / rows_a_sample;
    };
    const size_t first = sampleRow(rows.first_row);
    const size_t end = sampleRow(rows.first_row + rows.row_count);
    std::fill_n(planes + offset + first * stride, (end - first) * stride, code);
  };
  fillRows(0, at.luma_stride, 1, abi::lumaOf(0, 0, 0));
  fillRows(at.cbOffset(), at.chroma_stride, shared_px, abi::cbOf(0, 0, 0));
  fillRows(at.crOffset(), at.chroma_stride, shared_px, abi::crOf(0, 0, 0));
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
  resizeExactly(is_rgba ? area_px : 0, color);
  resizeExactly(outputs.depth ? area_px : 0, depth);
  resizeExactly(outputs.mask ? area_px : 0, mask);
  resizeExactly(outputs.linear ? 4 * area_px : 0, linear);
  resizeExactly(outputs.records ? area_px : 0, records);
  if (is_rgba) return ycbcr.clear();
  resizeExactly(YcbcrLayout(job.layout->size_px, outputs.color).sizeBytes(), ycbcr);
}

void SweptAtlas::clearUnused(const TraceJob& job, const TraceOutputs& outputs, BandRows rows) {
  if (!hasUnusedPixels(job)) return;
  const bool is_rgba = outputs.color == ColorForm::kRgba;
  for (uint32_t row = rows.first_row; row < rows.first_row + rows.row_count; ++row) {
    forEachUnusedRun(job, row, [&](size_t first_px, size_t count) {
      if (is_rgba) std::fill_n(color.data() + first_px, count, kOpaqueBlack);
      if (outputs.depth) std::fill_n(depth.data() + first_px, count, 0.0F);
      if (outputs.mask) std::fill_n(mask.data() + first_px, count, uint8_t{0});
      if (outputs.linear) std::fill_n(linear.data() + 4 * first_px, 4 * count, 0.0F);
      if (outputs.records) std::fill_n(records.data() + first_px, count, abi::RayRecord{});
    });
  }
  if (!is_rgba) clearAbove(*job.layout, outputs.color, rows, ycbcr.data());
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
