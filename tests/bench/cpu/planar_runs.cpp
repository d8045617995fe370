// SPDX-License-Identifier: Apache-2.0
#include "bench/cpu/planar_runs.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "bench/cpu/light.h"
#include "bench/cpu/parallel_chunks.h"

namespace viewloom::bench {
namespace {

constexpr uint32_t kRowsPerChunk = 4;
// Distance that a line may stray from its samples, in px of the source, in the outermost view.
constexpr double kTolerance_px = 0.25;
// Columns are drawn so many at a time; rows of depths go on by as many.
constexpr int kLanes = 16;
// The low bits of a depth say whose it is; the nearer layer wins a draw.
constexpr int kLayerBits = 3;
constexpr int kNothing = -1;  // is less than any depth

}  // namespace

// Runs of one row of the source, layer by layer, each layer from the left.
struct PlanarRuns::Runs {
  std::vector<float> begin_px;
  std::vector<float> end_px;
  std::vector<float> inv_z;  // where the line meets x = 0
  std::vector<float> slope;  // 1/m per px
  std::vector<int> layer_tag;
  std::vector<uint8_t> is_linked;  // to the run before it

  void clear() {
    for (auto* plane : {&begin_px, &end_px, &inv_z, &slope}) plane->clear();
    layer_tag.clear();
    is_linked.clear();
  }
};

struct PlanarRuns::Scratch {
  const Runs* runs = nullptr;
  std::vector<uint32_t> rgba;  // of the row: [layer][x]
  // Runs of a view: their columns, and their lines over them.
  std::vector<int> begin;
  std::vector<int> end;
  std::vector<float> inv_z;
  std::vector<float> slope;
  std::vector<int> depth;  // [column]: bits of inv_z, layer in the lowest

  void project(const RowView& view, uint32_t width_px);
  void draw();
  template <bool kWantsInvZ>
  void resolve(const RowView& view, const RowOutput& output, int source_width_px,
               uint32_t background) const;
};

PlanarRuns::PlanarRuns() = default;
PlanarRuns::~PlanarRuns() = default;

void PlanarRuns::prepare(const BenchLoad& load) {
  RowContestant::prepare(load);
  const uint32_t width_px = load.source.size_px.width;
  const double span_px = std::max(load.disparity_span_px, kTolerance_px);
  tolerance_ = float(kTolerance_px * double{load.source.inv_z_max} / span_px);
  inverse_.assign(width_px + 1, 0);
  for (uint32_t n = 1; n <= width_px; ++n) inverse_[n] = 1.0F / float(n);
  runs_.assign(load.source.size_px.height, {});
  scratch_.clear();
  const size_t sample_count = size_t{width_px} * load.source.inv_z.size();
  for (uint32_t thread = 0; thread < processorCount(); ++thread) {
    Scratch& scratch = *scratch_.emplace_back(std::make_unique<Scratch>());
    scratch.rgba.resize(sample_count);
    for (auto* plane : {&scratch.begin, &scratch.end}) plane->resize(sample_count);
    for (auto* plane : {&scratch.inv_z, &scratch.slope}) plane->resize(sample_count);
    scratch.depth.resize(load.job.layout->tile_size_px.width + size_t{kLanes});
  }
}

void PlanarRuns::build() {
  forChunks(uint32_t(usedRowCount()), kRowsPerChunk, [&](uint32_t, uint32_t first, uint32_t last) {
    for (uint32_t index = first; index < last; ++index) {
      Runs& runs = runs_[usedRow(index)];
      runs.clear();
      for (uint32_t layer = 0; layer < source().inv_z.size(); ++layer) {
        addRuns(layer, usedRow(index), runs);
      }
    }
  });
}

void PlanarRuns::addRuns(uint32_t layer, uint32_t source_row, Runs& runs) const {
  const uint32_t width_px = source().size_px.width;
  const float* const inv_z = source().inv_z[layer].data() + size_t{source_row} * width_px;
  const StepRule kappa = source().kappa;
  bool is_linked = false;
  for (uint32_t begin = 0; begin < width_px;) {
    const float anchor = inv_z[begin];
    uint32_t x = begin + 1;
    if (anchor < 0) {
      begin = x;
      is_linked = false;
      continue;
    }
    float slope_min = -INFINITY;
    float slope_max = INFINITY;
    bool links = false;
    for (float before = anchor; x < width_px; ++x) {
      const float w = inv_z[x];
      links = w >= 0 && std::abs(w - before) <= kappa.at(std::max(w, before));
      const float inverse = inverse_[x - begin];
      const float least = std::max(slope_min, (w - anchor - tolerance_) * inverse);
      const float most = std::min(slope_max, (w - anchor + tolerance_) * inverse);
      if (!links || least > most) break;
      slope_min = least;
      slope_max = most;
      before = w;
    }
    const float slope = x == begin + 1 ? 0.0F : 0.5F * (slope_min + slope_max);
    runs.begin_px.push_back(float(begin));
    runs.end_px.push_back(float(x));
    runs.inv_z.push_back(anchor - slope * (float(begin) + 0.5F));
    runs.slope.push_back(slope);
    runs.layer_tag.push_back(kLayerBits - int(layer));
    runs.is_linked.push_back(is_linked ? 1 : 0);
    is_linked = links && x < width_px;
    begin = x;
  }
}

void PlanarRuns::enterRow(uint32_t thread, uint32_t source_row) {
  Scratch& scratch = *scratch_[thread];
  scratch.runs = &runs_[source_row];
  const uint32_t width_px = source().size_px.width;
  for (size_t layer = 0; layer < source().rgba.size(); ++layer) {
    std::copy_n(source().rgba[layer].data() + size_t{source_row} * width_px, width_px,
                scratch.rgba.data() + layer * width_px);
  }
}

void PlanarRuns::Scratch::project(const RowView& view, uint32_t width_px) {
  const float scale = 1 / view.step_px;
  const float eye = view.eye_px_m;
  const float start = view.start_px;
  const float step = view.step_px;
  const float last = float(width_px);
  const float* const from_px = runs->begin_px.data();
  const float* const to_px = runs->end_px.data();
  const float* const line = runs->inv_z.data();
  const float* const line_slope = runs->slope.data();
  int* const first = begin.data();
  int* const past = end.data();
  float* const seen = inv_z.data();
  float* const seen_slope = slope.data();
  const int count = int(runs->slope.size());
#pragma omp simd
  for (int k = 0; k < count; ++k) {
    // x = start + step p + eye w and w = line + slope x
    const float b = line_slope[k];
    const float forward = 1 - eye * b;
    const float from = (from_px[k] * forward - eye * line[k] - start) * scale;
    const float to = (to_px[k] * forward - eye * line[k] - start) * scale;
    first[k] = int(std::ceil(clampTo(from, 0, last)));
    past[k] = int(std::ceil(clampTo(to, 0, last)));
    seen[k] = (line[k] + b * start) / forward;
    seen_slope[k] = b * step / forward;
  }
}

void PlanarRuns::Scratch::draw() {
  std::fill(depth.begin(), depth.end(), kNothing);
  const size_t count = runs->slope.size();
  int end_before = 0;
  for (size_t k = 0; k < count; ++k) {
    // Lines of connected runs need not meet: the second goes back to where the first ended.
    const int from = runs->is_linked[k] != 0 ? std::min(begin[k], end_before) : begin[k];
    const int to = end_before = end[k];
    const int tag = runs->layer_tag[k];
    const float line = inv_z[k];
    const float line_slope = slope[k];
    for (int p = from; p < to; p += kLanes) {
      int* const block = depth.data() + p;
#pragma omp simd
      for (int lane = 0; lane < kLanes; ++lane) {
        const float w = line + line_slope * float(p + lane);
        const int bits = std::bit_cast<int>(w < 0 ? 0 : w) & ~kLayerBits;
        const int key = p + lane < to ? bits | tag : kNothing;
        block[lane] = block[lane] < key ? key : block[lane];
      }
    }
  }
}

template <bool kWantsInvZ>
void PlanarRuns::Scratch::resolve(const RowView& view, const RowOutput& output, int source_width_px,
                                  uint32_t background) const {
  const RowView ray = view;
  const int width_px = int(output.width_px);
  const float last = float(source_width_px - 1);
  const int* const keys = depth.data();
  const uint32_t* const colors = rgba.data();
  uint32_t* const out = output.rgba;
#pragma omp simd
  for (int p = 0; p < width_px; ++p) {
    const int key = keys[p];
    const bool is_hit = key >= 0;
    const float w = is_hit ? std::bit_cast<float>(key & ~kLayerBits) : 0.0F;
    const int layer = is_hit ? kLayerBits - (key & kLayerBits) : 0;
    const float x = ray.start_px + ray.step_px * float(p) + ray.eye_px_m * w;
    const float inside = clampTo(x, 0, last);
    const uint32_t color = colors[layer * source_width_px + int(inside)];
    out[p] = is_hit ? color | kOpaqueCode : background;
    if constexpr (kWantsInvZ) output.inv_z[p] = is_hit ? w : kNoSurface;
  }
}

void PlanarRuns::drawRow(uint32_t thread, const RowView& view, const RowOutput& output) {
  Scratch& row = *scratch_[thread];
  row.project(view, output.width_px);
  row.draw();
  const int width_px = int(source().size_px.width);
  if (output.inv_z == nullptr)
    row.resolve<false>(view, output, width_px, background());
  else
    row.resolve<true>(view, output, width_px, background());
}

}  // namespace viewloom::bench
