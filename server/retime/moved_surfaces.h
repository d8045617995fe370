// SPDX-License-Identifier: Apache-2.0
// The samples of a source and which of them are connected, and where they are after some time.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "base/worker_pool.h"
#include "frame/frame.h"
#include "retime/columns.h"
#include "retime/move_kernels.h"
#include "retime/moved_samples.h"
#include "retime/surface_links.h"
#include "sweep/aligned_array.h"
#include "sweep/sweep_source.h"

namespace viewloom {

// Samples are numbered through, as in MovedSamples.
// Thread-safety: none while it is prepared or moved, then immutable.
class MovedSurfaces {
 public:
  // The first source of the frame: no cube map, with motion.
  void prepare(FramePtr frame, WorkerPool& workers);
  // From where the frame has them; negative: to before the frame.
  void move(double seconds, WorkerPool& workers);

  SizePx sizePx() const { return size_px_; }
  uint32_t layerCount() const { return layer_count_; }
  const Frame& frame() const { return *frame_; }
  uint32_t sampleAt(uint32_t layer, uint32_t x, uint32_t y) const {
    return (layer * size_px_.height + y) * size_px_.width + x;
  }
  uint32_t layerOf(uint32_t sample) const { return sample / uint32_t(size_px_.area()); }
  uint32_t pxOf(uint32_t sample) const { return sample % uint32_t(size_px_.area()); }
  const SurfaceSteps& steps() const { return steps_; }
  // 1/Z of the frame, in canonical form (sweep/depth_columns.h).
  const float* heldRow(uint32_t layer, uint32_t y) const { return held_inv_z_->row(layer, int(y)); }

  // Columns of a row outside of which nothing moves in it, on no layer.
  Columns movingColumns(uint32_t y) const { return moving_columns_[y]; }
  // Those of samples from which quads may go that move.
  Columns quadColumns(uint32_t y) const;
  // Those outside of which px are as the frame has them, after the move: nothing of what moves has
  // been there, or has come there, and no light of its edges.
  Columns freshColumns(uint32_t y) const { return fresh_columns_[y]; }
  // Those of px that may lie beside an edge of what moves.
  Columns rimColumns(uint32_t y) const;

  // 1/Z of the first layer in the frame: 1/m, abi::kNoSurface where nothing is.
  float frontInvZ(uint32_t px) const {
    return heldRow(0, px / size_px_.width)[px % size_px_.width];
  }
  // Links of rows near moving surfaces.
  const SurfaceLinks& links() const { return links_; }

  const MovedSamples& samples() const { return samples_; }
  // 1/m, after the move; abi::kNoSurface also for what has come behind the camera.
  float invZ(uint32_t sample) const { return inv_z_[sample]; }
  bool exists(uint32_t sample) const { return invZ(sample) >= 0; }
  bool moves(uint32_t sample) const { return moves_[sample] != 0; }
  // px, after the move.
  glm::dvec2 place(uint32_t sample) const;
  // px, from where the frame has it.
  glm::dvec2 way(uint32_t sample) const { return {dx_px_[sample], dy_px_[sample]}; }

 private:
  void beginFrame(WorkerPool& workers);
  void clearRow(uint32_t y);
  void standRow(uint32_t y);
  bool isNearMoving(uint32_t y) const;
  void moveRows(uint32_t y, const std::array<glm::dvec3, 3>& axes_s);
  void findFreshColumns();

  FramePtr frame_;
  SizePx size_px_;
  uint32_t layer_count_ = 0;
  SweepSource columns_;
  const DepthColumns* held_inv_z_ = nullptr;  // its
  SurfaceSteps steps_;
  SurfaceLinks links_;
  std::vector<Columns> moving_columns_;  // [row]
  std::vector<WayRange> ways_;           // [row], of what moves in it, px
  std::vector<Columns> fresh_columns_;   // [row]
  // [sample]
  AlignedArray<float> dx_px_, dy_px_, inv_z_;
  AlignedArray<uint8_t> moves_, covered_;
  AlignedArray<QuadLayers> drawn_quads_;  // from its second element on
  MovedSamples samples_;
};

}  // namespace viewloom
