// SPDX-License-Identifier: Apache-2.0
#include "sweep/sweep_source.h"

#include <algorithm>
#include <utility>

namespace viewloom {
namespace {

// Pieces of a frame's height that threads take: whole blocks of what is measured.
constexpr uint32_t kRowsPerPiece = 16;
static_assert(kRowsPerPiece % abi::kBlockPx == 0);
constexpr uint32_t kBlockRowsPerPiece = kRowsPerPiece / abi::kBlockPx;

uint32_t pieceCount(size_t count, uint32_t per_piece) {
  return uint32_t((count + per_piece - 1) / per_piece);
}

}  // namespace

bool canSweep(const FrameFormat& format) {
  if (format.sources.size() != 1 || format.sources.front().is_cube_map) return false;
  const std::vector<LayerFormat>& layers = format.sources.front().layers;
  const SizePx size_px = layers.front().depth.size_px;
  return format.exposure_ev == 0 && std::ranges::all_of(layers, [&](const LayerFormat& layer) {
           return layer.color.size_px == size_px && layer.color.transfer == ColorTransfer::kSrgb &&
                  layer.color.primaries == ColorPrimaries::kBt709 &&
                  layer.color.alpha == AlphaMode::kOpaque &&
                  layer.color.encoding != PlaneEncoding::kRgba16f;
         });
}

bool canSweep(const Frame& frame) {
  return canSweep(frame.format) &&
         std::ranges::all_of(frame.sources.front(), [](const LayerPlanes& layer) {
           return layer.color_encoding == PlaneEncoding::kRgba8;
         });
}

uint64_t SweepSource::bytesFor(const FrameFormat& format) {
  const std::vector<LayerFormat>& layers = format.sources.front().layers;
  return DepthColumns::bytesFor(layers.front().depth.size_px, uint32_t(layers.size()));
}

void SweepSource::prepare(FramePtr frame, WorkerPool& workers) {
  frame_ = std::move(frame);
  columns_.beginFrame(*frame_);
  const SizePx size_px = columns_.sizePx();
  std::vector<ColumnCounts> counts(workers.workerCount());
  workers.forEach(pieceCount(size_px.height, kRowsPerPiece), [&](uint32_t piece, uint32_t worker) {
    const uint32_t first = piece * kRowsPerPiece;
    counts[worker].add(
        columns_.prepareRows(first, std::min(kRowsPerPiece, size_px.height - first)));
  });
  for (size_t worker = 1; worker < counts.size(); ++worker) counts[0].add(counts[worker]);
  const ColumnHistograms histograms = measured(ColumnHistograms{}, workers);
  const RangeHistogram range = measured(RangeHistogram{settleRange(histograms)}, workers);
  const float given_kappa = float(frame_->format.sources.front().connection_tolerance);
  measured_ = settleColumns(histograms, range, counts[0], size_px.width, given_kappa);
  if (measured_.smoothing.reach > 0) smooth(workers);
}

template <typename Histogram>
Histogram SweepSource::measured(const Histogram& empty, WorkerPool& workers) const {
  const uint32_t block_rows = pieceCount(columns_.sizePx().height, abi::kBlockPx);
  std::vector<Histogram> by_worker(workers.workerCount(), empty);
  workers.forEach(pieceCount(block_rows, kBlockRowsPerPiece), [&](uint32_t piece, uint32_t worker) {
    const uint32_t first = piece * kBlockRowsPerPiece;
    const uint32_t end = std::min(first + kBlockRowsPerPiece, block_rows);
    for (uint32_t row = first; row < end; ++row) by_worker[worker].addBlockRow(columns_, row);
  });
  for (size_t worker = 1; worker < by_worker.size(); ++worker) by_worker[0].add(by_worker[worker]);
  return by_worker[0];
}

void SweepSource::smooth(WorkerPool& workers) {
  const uint32_t height = columns_.sizePx().height;
  const uint32_t last_pass = abi::kSmoothingPassCount - 1;
  columns_.beginSmoothing(measured_.smoothing);
  std::vector<ColumnCounts> ranges(workers.workerCount());
  for (uint32_t pass = measured_.smoothing.first_pass; pass <= last_pass; ++pass) {
    workers.forEach(pieceCount(height, kRowsPerPiece), [&](uint32_t piece, uint32_t worker) {
      const uint32_t first = piece * kRowsPerPiece;
      const ColumnCounts range =
          columns_.smoothRows(pass, first, std::min(kRowsPerPiece, height - first));
      if (pass == last_pass) ranges[worker].add(range);
    });
  }
  for (size_t worker = 1; worker < ranges.size(); ++worker) ranges[0].add(ranges[worker]);
  measured_.stats.inv_z_min = ranges[0].inv_z_min;
  measured_.stats.inv_z_max = ranges[0].inv_z_max;
}

RowSource SweepSource::rowSource() const {
  RowSource source{.columns = &columns_, .steps = measured_.steps};
  for (uint32_t i = 0; i < columns_.layerCount(); ++i) {
    source.color[i] = reinterpret_cast<const uint32_t*>(frame_->sources.front()[i].color->data());
  }
  return source;
}

}  // namespace viewloom
