// SPDX-License-Identifier: Apache-2.0
#include "retime/fresh_grid.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "sweep/link_kernels.h"
#include "sweep/row_source.h"

namespace viewloom {
namespace {

// The px whose middle lies in the footprint around a place, and from there to the middle.
struct FootprintPx {
  explicit FootprintPx(double place) : index(std::floor(place)), beyond(index + 0.5 - place) {
    // Half-open, so that footprints a px apart meet and do not overlap.
    if (beyond < 0.5) return;
    index -= 1;
    beyond = index + 0.5 - place;
  }

  double index;
  double beyond;
};

uint32_t quadrantOf(double right, double below) {
  if (below < 0) return right < 0 ? 0 : 1;
  return right < 0 ? 3 : 2;
}

}  // namespace

void FreshGrid::draw(const MovedSurfaces& surfaces, const float* in_front, WorkerPool& workers) {
  surfaces_ = &surfaces;
  in_front_ = in_front;
  const SizePx size_px = surfaces.sizePx();
  nearest_.reserve(size_px.area() + kRowSlack);
  // Each px by itself; nothing else is there yet.
  forEachRow(size_px, workers, [&](uint32_t y, uint32_t) {
    const Columns columns = surfaces.freshColumns(y);
    const uint32_t px = y * size_px.width + columns.first;
    drawStill(surfaces.samples(), px, columns.count(), in_front, nearest_.data() + px);
  });
  forEachRow(size_px, workers, [&](uint32_t y, uint32_t) { drawRow(y); });
}

// Draws moving surfaces.
void FreshGrid::drawRow(uint32_t y) {
  const MovedSamples& samples = surfaces_->samples();
  const uint32_t width = samples.size_px.width;
  const Columns quads = surfaces_->quadColumns(y), moving = surfaces_->movingColumns(y);
  Fragments fragments;
  for (uint32_t layer = 0; layer < samples.layer_count; ++layer) {
    for (uint32_t x = quads.first; x < quads.end; x += kQuadsPerCall) {
      drawQuads(samples, layer, y * width + x, std::min(kQuadsPerCall, quads.end - x), fragments);
      for (uint32_t i = 0; i < fragments.count; ++i) {
        offer(uint32_t(fragments.px[i]), fragments.keys[i]);
      }
    }
    const uint8_t* const covered = samples.covered + samples.sampleAt(layer, 0, y);
    const auto next = [&](uint32_t x) {
      return x < moving.end ? findOther(covered, x, moving.end, kAllQuadrants) : x;
    };
    for (uint32_t x = next(moving.first); x < moving.end; x = next(x + 1)) {
      drawFootprint(layer, x, y);
    }
  }
}

// Quarters of it that lie in no quad: at most one has the middle of a px.
void FreshGrid::drawFootprint(uint32_t layer, uint32_t x, uint32_t y) {
  const MovedSamples& samples = surfaces_->samples();
  const uint32_t sample = samples.sampleAt(layer, x, y);
  if (!(samples.inv_z[sample] >= 0)) return;
  const FootprintPx column(x + 0.5 + double{samples.dx_px[sample]});
  const FootprintPx row(y + 0.5 + double{samples.dy_px[sample]});
  const auto isInside = [](double index, uint32_t count) { return index >= 0 && index < count; };
  if (!isInside(column.index, samples.size_px.width) ||
      !isInside(row.index, samples.size_px.height)) {
    return;
  }
  const uint32_t quadrant = quadrantOf(column.beyond, row.beyond);
  if ((samples.covered[sample] & (1U << quadrant)) != 0) return;
  const uint32_t px = uint32_t(row.index) * samples.size_px.width + uint32_t(column.index);
  offer(px,
        pieceKey(samples.inv_z[sample] + 0.0F, sample * kPieceKinds + kFirstQuadrant + quadrant));
}

// Standing surfaces have layers of their own, one behind the other. Neighbouring moving pieces may
// both reach over a pixel: if they are no further apart than kappa, they are one surface.
void FreshGrid::offer(uint32_t px, uint64_t key) {
  if (in_front_ != nullptr) {
    const float in_front = in_front_[px];
    const float apart = surfaces_->steps().kappa.at(in_front);
    if (!(in_front >= 0 && in_front - invZOfKey(key) > apart)) return;
  }
  const std::atomic_ref nearest(nearest_[px]);
  uint64_t known = nearest.load(std::memory_order_relaxed);
  while (known < key && !nearest.compare_exchange_weak(known, key, std::memory_order_relaxed)) {
  }
}

void FreshGrid::findRow(uint32_t y, BlendedRow& row) const {
  const MovedSamples& samples = surfaces_->samples();
  const Columns columns = surfaces_->freshColumns(y);
  const uint32_t px = y * samples.size_px.width + columns.first;
  findBlends(samples, px, columns.count(), nearest_.data() + px, row);
}

}  // namespace viewloom
