// SPDX-License-Identifier: Apache-2.0
// Which samples of a source are connected, as the frame has them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/worker_pool.h"
#include "retime/columns.h"
#include "retime/moved_samples.h"
#include "sweep/aligned_array.h"
#include "sweep/depth_columns.h"
#include "sweep/measure_columns.h"

namespace viewloom {

// Keeps its memory from frame to frame. Samples are numbered through, as in MovedSamples.
// Thread-safety: none while links are found, then immutable.
class SurfaceLinks {
 public:
  // Links of the rows for which `asks`, and those of the quads that begin in `quadColumns` of a
  // row. `held` stay as they are while links are asked.
  template <typename Asks, typename QuadColumns>
  void find(const DepthColumns& held, const SurfaceSteps& steps, WorkerPool& workers,
            const Asks& asks, const QuadColumns& quadColumns) {
    std::vector<Scratch> scratch = begin(held, steps, workers.workerCount());
    forEachRow(size_px_, workers, [&](uint32_t y, uint32_t worker) {
      if (asks(y)) linkRow(int(y), scratch[worker]);
    });
    forEachRow(size_px_, workers, [&](uint32_t y, uint32_t) { quadRow(y, quadColumns(y)); });
  }

  // Whether surfaces of the first layer are connected to the next px in the row, and in the column.
  bool joinsRight(uint32_t px) const { return to_right_[px] == 1; }
  bool joinsBelow(uint32_t px) const { return to_below_[px] == 1; }
  bool areJoined(uint32_t px, uint32_t beside) const {
    const uint32_t first = std::min(px, beside);
    return areInRow(px, beside) ? joinsRight(first) : joinsBelow(first);
  }
  // False only where it is connected on all sides.
  bool isBesideEdge(uint32_t px) const {
    const uint32_t width = size_px_.width;
    return !joinsRight(px) || !joinsBelow(px) || px < width || !joinsBelow(px - width) ||
           !joinsRight(px - 1);
  }
  // The sample of a deeper layer at `px` that is connected to the first layer's in `other`, which
  // is beside it.
  std::optional<uint32_t> joinedBehind(uint32_t px, uint32_t other) const;
  // [sample]; whether or not they are drawn.
  const QuadLayers* quads() const { return quads_.data(); }

 private:
  // Rows that kernels write, a vector beyond their width.
  struct Scratch {
    Scratch(uint32_t width, uint32_t layer_count);

    ByLayer<AlignedArray<float>> slope_x, slope_y, slope_y_below;
    ByLayer<AlignedArray<uint8_t>> to_right, to_left, to_below, to_above;
  };

  std::vector<Scratch> begin(const DepthColumns& held, const SurfaceSteps& steps,
                             uint32_t worker_count);
  void linkRow(int y, Scratch& scratch);
  void quadRow(uint32_t y, const Columns& columns);
  bool areInRow(uint32_t px, uint32_t beside) const {
    return size_px_.width > 1 && std::max(px, beside) - std::min(px, beside) == 1;
  }
  uint32_t sampleAt(uint32_t layer, uint32_t y) const {
    return (layer * size_px_.height + y) * size_px_.width;
  }

  const DepthColumns* held_ = nullptr;
  SizePx size_px_;
  uint32_t layer_count_ = 0;
  SurfaceSteps steps_;
  AlignedArray<uint8_t> to_right_;  // [sample], as sweep/link_kernels.h
  AlignedArray<uint8_t> to_below_;
  AlignedArray<QuadLayers> quads_;
};

}  // namespace viewloom
