// SPDX-License-Identifier: Apache-2.0
#include "bench/cpu/sample_rows.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "bench/cpu/light.h"
#include "bench/cpu/parallel_chunks.h"

namespace viewloom::bench {
namespace {

// Segments are looked for eight at a time, by a byte each.
constexpr uint32_t kWord = 8;

bool areConnected(const LoadSource& source, float a, float b) {
  return std::min(a, b) >= 0 && std::abs(a - b) <= source.kappa.at(std::max(a, b));
}

}  // namespace

// Points of a row, layer by layer, each layer from the left; vertex k begins the segment to k + 1.
struct SampleRows::Scratch {
  std::vector<float> x_px;
  std::vector<float> inv_z;
  std::vector<float> slope;  // of the segment, 1/m per px
  std::vector<uint32_t> rgba;
  std::vector<int16_t> is_linked;   // to the next one
  std::vector<int16_t> column;      // the first of the view whose centre is not left of the vertex
  std::vector<uint8_t> is_drawn;    // the segment holds the centre of a column
  std::vector<uint32_t> layer_end;  // a multiple of kWord
  std::vector<int32_t> segment;     // [column]: the one that is seen; -1: none
  uint32_t count = 0;

  void resize(size_t vertex_count, size_t column_count, size_t layer_count) {
    for (auto* plane : {&x_px, &inv_z, &slope}) plane->assign(vertex_count + 1, 0);
    rgba.assign(vertex_count + 1, 0);
    is_linked.assign(vertex_count + 1, 0);
    column.assign(vertex_count + 1, 0);
    is_drawn.assign(vertex_count + kWord, 0);
    segment.assign(column_count, -1);
    layer_end.assign(layer_count, 0);
  }
  void add(float x, float w, uint32_t color, bool links) {
    x_px[count] = x;
    inv_z[count] = w;
    rgba[count] = color;
    is_linked[count++] = links ? 1 : 0;
  }
  void findSegments(const RowView& view, uint32_t width_px);
  template <bool kIsForward, bool kIsFirst>
  void drawLayer(uint32_t begin, uint32_t end);
  template <bool kWantsInvZ>
  void resolve(const RowView& view, const RowOutput& output, uint32_t background) const;
};

SampleRows::SampleRows() = default;
SampleRows::~SampleRows() = default;

void SampleRows::prepare(const BenchLoad& load) {
  RowContestant::prepare(load);
  scratch_.clear();
  const size_t layer_count = load.source.inv_z.size();
  for (uint32_t thread = 0; thread < processorCount(); ++thread) {
    scratch_.push_back(std::make_unique<Scratch>());
    // A lone sample has both its ends beside it.
    scratch_.back()->resize(layer_count * (3 * size_t{load.source.size_px.width} + kWord),
                            load.job.layout->tile_size_px.width, layer_count);
  }
}

void SampleRows::enterRow(uint32_t thread, uint32_t source_row) {
  Scratch& row = *scratch_[thread];
  const uint32_t width_px = source().size_px.width;
  row.count = 0;
  for (size_t layer = 0; layer < source().inv_z.size(); ++layer) {
    const float* inv_z = source().inv_z[layer].data() + size_t{source_row} * width_px;
    const uint32_t* rgba = source().rgba[layer].data() + size_t{source_row} * width_px;
    float before = kNoSurface;
    for (uint32_t x = 0; x < width_px; ++x) {
      const float w = inv_z[x];
      const float next = x + 1 < width_px ? inv_z[x + 1] : kNoSurface;
      const bool is_linked = areConnected(source(), w, next);
      if (w >= 0 && !areConnected(source(), before, w)) row.add(float(x), w, rgba[x], true);
      if (w >= 0) row.add(float(x) + 0.5F, w, rgba[x], true);
      if (w >= 0 && !is_linked) row.add(float(x) + 1, w, rgba[x], false);
      before = w;
    }
    while (row.count % kWord != 0) row.add(0, 0, 0, false);
    row.layer_end[layer] = row.count;
  }
  for (uint32_t k = 0; k < row.count; ++k) {
    const float length_px = row.x_px[k + 1] - row.x_px[k];
    row.slope[k] = row.is_linked[k] != 0 ? (row.inv_z[k + 1] - row.inv_z[k]) / length_px : 0.0F;
  }
}

void SampleRows::Scratch::findSegments(const RowView& view, uint32_t width_px) {
  const float scale = 1 / view.step_px;
  const float eye = -view.eye_px_m * scale;
  const float start = -view.start_px * scale;
  const float last = float(width_px);
  const float* const x = x_px.data();
  const float* const w = inv_z.data();
  const int16_t* const linked = is_linked.data();
  int16_t* const columns = column.data();
  uint8_t* const drawn = is_drawn.data();
  const int vertex_count = int(count);
#pragma omp simd
  for (int k = 0; k < vertex_count; ++k) {
    const float at = x[k] * scale + (w[k] * eye + start);
    columns[k] = int16_t(int(std::ceil(clampTo(at, 0, last))));
  }
#pragma omp simd
  for (int k = 0; k < vertex_count; ++k) {
    drawn[k] = uint8_t(linked[k] & int16_t(columns[k + 1] > columns[k]));
  }
}

template <bool kIsForward, bool kIsFirst>
void SampleRows::Scratch::drawLayer(uint32_t begin, uint32_t end) {
  const int16_t* const columns = column.data();
  const uint8_t* const drawn = is_drawn.data();
  const float* const w = inv_z.data();
  int32_t* const seen = segment.data();
  for (uint32_t at = begin; at < end; at += kWord) {
    const uint32_t first = kIsForward ? at : begin + end - kWord - at;
    uint64_t word = 0;
    std::memcpy(&word, drawn + first, sizeof(word));
    while (word != 0) {
      const int bit = kIsForward ? std::countr_zero(word) : 63 - std::countl_zero(word);
      word ^= uint64_t{1} << bit;
      const uint32_t k = first + uint32_t(bit) / 8;
      int p = columns[k];
      const int end_column = columns[k + 1];
      do {
        if (kIsFirst || seen[p] < 0 || w[k] > w[seen[p]]) seen[p] = int32_t(k);
      } while (++p < end_column);
    }
  }
}

template <bool kWantsInvZ>
void SampleRows::Scratch::resolve(const RowView& view, const RowOutput& output,
                                  uint32_t background) const {
  const float* const x = x_px.data();
  const float* const w = inv_z.data();
  const float* const slopes = slope.data();
  const uint32_t* const colors = rgba.data();
  const int32_t* const seen = segment.data();
  uint32_t* const out = output.rgba;
  const RowView ray = view;
  const int width_px = int(output.width_px);
#pragma omp simd
  for (int p = 0; p < width_px; ++p) {
    const int found = seen[p];
    const int k = found < 0 ? 0 : found;
    // x + t = start + step p + eye (w + slope t)
    const float ahead = ray.start_px + ray.step_px * float(p) - x[k] + ray.eye_px_m * w[k];
    const float t = clampTo(ahead / (1 - ray.eye_px_m * slopes[k]), 0, 1);
    const uint32_t color = blendCodes(colors[k], colors[k + 1], t);
    out[p] = found < 0 ? background : color;
    if constexpr (kWantsInvZ) output.inv_z[p] = found < 0 ? kNoSurface : w[k] + slopes[k] * t;
  }
}

void SampleRows::drawRow(uint32_t thread, const RowView& view, const RowOutput& output) {
  Scratch& row = *scratch_[thread];
  row.findSegments(view, output.width_px);
  std::fill(row.segment.begin(), row.segment.end(), -1);
  uint32_t begin = 0;
  for (const uint32_t end : row.layer_end) {
    // An eye to the right sees what is right of it before what is left.
    const bool is_forward = view.eye_px_m > 0;
    if (is_forward && begin == 0) row.drawLayer<true, true>(begin, end);
    if (is_forward && begin != 0) row.drawLayer<true, false>(begin, end);
    if (!is_forward && begin == 0) row.drawLayer<false, true>(begin, end);
    if (!is_forward && begin != 0) row.drawLayer<false, false>(begin, end);
    begin = end;
  }
  if (output.inv_z == nullptr)
    row.resolve<false>(view, output, background());
  else
    row.resolve<true>(view, output, background());
}

}  // namespace viewloom::bench
