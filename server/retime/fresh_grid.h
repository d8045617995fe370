// SPDX-License-Identifier: Apache-2.0
// What a source's px show once its surfaces have moved: the nearest of all, then what lies behind.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/worker_pool.h"
#include "retime/moved_surfaces.h"

namespace viewloom {

// The samples that a px lies between, and their shares, whose sum is 1.
struct Blend {
  std::array<uint32_t, 3> samples{};
  std::array<double, 3> shares{};
  uint32_t count = 0;

  bool operator==(const Blend&) const = default;
};

// One layer at a time, front to back. The nearest wins by the maximum of 64 bits, 1/Z before the
// number of the piece of surface: whatever threads draw in whatever order, the answer is the same.
// Thread-safety: none; it shares its work among threads.
class FreshGrid {
 public:
  // Draws the layer in front. `surfaces` stay as they are until the last layer is drawn.
  void drawFirst(const MovedSurfaces& surfaces, WorkerPool& workers);
  // Draws the next one behind it.
  void drawNext(const MovedSurfaces& surfaces, WorkerPool& workers);

  // Of the layer drawn last: 1/m, abi::kNoSurface where nothing is.
  float invZ(uint32_t px) const;
  // Of the layer drawn last, the sample whose px it is and that has not moved.
  std::optional<uint32_t> stillSample(uint32_t px) const;
  // Where something is.
  Blend blend(const MovedSurfaces& surfaces, uint32_t px) const;

 private:
  void draw(const MovedSurfaces& surfaces, WorkerPool& workers);
  void drawStillRow(const MovedSurfaces& surfaces, uint32_t y);
  void drawSample(const MovedSurfaces& surfaces, uint32_t sample);
  template <typename BlendAt>
  void drawPiece(const MovedSurfaces& surfaces, uint32_t piece, const glm::dvec2& low_px,
                 const glm::dvec2& high_px, const BlendAt& blendAt);
  bool isBehind(uint32_t px, float inv_z, float apart) const;
  void offer(uint32_t px, float inv_z, uint32_t piece);

  SizePx size_px_;
  Kappa kappa_;
  bool is_first_ = true;
  std::vector<uint64_t> nearest_;  // [px]; 0: nothing
  std::vector<float> in_front_;    // [px], 1/m, of the layer before
};

}  // namespace viewloom
