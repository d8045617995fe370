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
  bool hadSurface(uint32_t x, uint32_t y) const {
    return columns_.rowSource().columns->row(0, int(y))[x] >= 0;
  }

  // 1/m, after the move; abi::kNoSurface also for what has come behind the camera.
  float invZ(uint32_t sample) const { return moved_[sample].inv_z; }
  bool exists(uint32_t sample) const { return invZ(sample) >= 0; }
  bool isStill(uint32_t sample) const { return moved_[sample].is_still; }
  // px, after the move.
  glm::dvec2 place(uint32_t sample) const;
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

  void linkRow(int y, LinkScratch& scratch);
  void moveRow(uint32_t layer, uint32_t y, const glm::dvec3& to_camera_x,
               const glm::dvec3& to_camera_y, const glm::dvec3& to_camera_z);
  void noteQuads(uint32_t layer, uint32_t y);
  bool isTorn(uint32_t a, uint32_t b) const;

  FramePtr frame_;
  SizePx size_px_;
  uint32_t layer_count_ = 0;
  SweepSource columns_;
  Kappa kappa_;
  std::vector<uint8_t> to_right_;  // [sample], as sweep/link_kernels.h
  std::vector<uint8_t> to_below_;
  std::vector<Moved> moved_;
  std::vector<uint8_t> in_quads_;
};

}  // namespace viewloom
