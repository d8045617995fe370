// SPDX-License-Identifier: Apache-2.0
// The samples of a source and which of them are connected, and where they are after some time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "base/worker_pool.h"
#include "frame/frame.h"
#include "sweep/sweep_source.h"

namespace viewloom {

// Work on rows is shared among threads in pieces of so many.
inline constexpr uint32_t kRetimedRowsPerPiece = 16;
inline uint32_t retimedPieceCount(SizePx size_px) {
  return (size_px.height + kRetimedRowsPerPiece - 1) / kRetimedRowsPerPiece;
}

// Sides of a sample's footprint, as bits.
enum Quadrant : uint8_t {
  kTopLeft = 1,
  kTopRight = 2,
  kBottomRight = 4,
  kBottomLeft = 8,
};

// Samples are numbered through: (layer * height + row) * width + column.
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
  const Kappa& kappa() const { return kappa_; }
  bool hadSurface(uint32_t x, uint32_t y) const { return heldRow(0, y)[x] >= 0; }
  // Columns of a row outside of which nothing moves in it, on no layer.
  struct Columns {
    uint32_t first = 0;
    uint32_t end = 0;
  };
  Columns movingColumns(uint32_t y) const { return moving_columns_[y]; }
  // Those of samples from which quads may go that move.
  Columns quadColumns(uint32_t y) const;

  // Of the first layer, as the frame has it: 1/m, abi::kNoSurface where nothing is.
  float frontInvZ(uint32_t px) const {
    return heldRow(0, px / size_px_.width)[px % size_px_.width];
  }
  // Whether surfaces of the first layer are connected to the next px in the row, and in the column.
  bool joinsRight(uint32_t px) const { return to_right_[px] == 1; }
  bool joinsBelow(uint32_t px) const { return to_below_[px] == 1; }
  // False only where it is connected on all sides.
  bool isBesideEdge(uint32_t px) const {
    const uint32_t width = size_px_.width;
    return !joinsRight(px) || !joinsBelow(px) || px < width || !joinsBelow(px - width) ||
           !joinsRight(px - 1);
  }
  // The sample of a deeper layer at `px` that is connected to the first layer's in `other`, which
  // is beside it.
  std::optional<uint32_t> joinedBehind(uint32_t px, uint32_t other) const;

  // 1/m, after the move; abi::kNoSurface also for what has come behind the camera.
  float invZ(uint32_t sample) const { return moved_[sample].inv_z; }
  bool exists(uint32_t sample) const { return invZ(sample) >= 0; }
  bool isStill(uint32_t sample) const { return moved_[sample].is_still; }
  // px, after the move.
  glm::dvec2 place(uint32_t sample) const;
  // px, from where the frame has it.
  glm::dvec2 way(uint32_t sample) const { return {moved_[sample].dx_px, moved_[sample].dy_px}; }
  // The connected surface between a sample, the next in its row and the two below them, in the
  // order of Quadrant; none where it is not connected all around, or has been torn apart.
  std::optional<std::array<uint32_t, 4>> quadFrom(uint32_t sample) const;
  // Which Quadrants of the sample's footprint lie in such a surface; of samples that move.
  uint8_t quadrantsInQuads(uint32_t sample) const { return in_quads_[sample]; }

 private:
  struct Moved {
    float dx_px = 0;
    float dy_px = 0;
    float inv_z = 0;
    bool is_still = true;
  };
  struct LinkScratch;

  // As the frame has it.
  const float* heldRow(uint32_t layer, uint32_t y) const { return held_inv_z_->row(layer, int(y)); }
  void linkRow(int y, LinkScratch& scratch);
  void standRow(uint32_t y);
  void moveRow(uint32_t layer, uint32_t y, const glm::dvec3& to_camera_x,
               const glm::dvec3& to_camera_y, const glm::dvec3& to_camera_z);
  void noteQuads(uint32_t layer, uint32_t y);
  bool isTorn(uint32_t a, uint32_t b) const;

  FramePtr frame_;
  SizePx size_px_;
  uint32_t layer_count_ = 0;
  SweepSource columns_;
  const DepthColumns* held_inv_z_ = nullptr;  // its
  Kappa kappa_;
  std::vector<uint8_t> to_right_;  // [sample], as sweep/link_kernels.h
  std::vector<uint8_t> to_below_;
  std::vector<Columns> moving_columns_;  // [row]
  std::vector<Moved> moved_;
  std::vector<uint8_t> in_quads_;
};

}  // namespace viewloom
