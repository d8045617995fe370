// SPDX-License-Identifier: Apache-2.0
// Surfaces at a source's pixels after motion: the nearest first, then those behind.
#pragma once

#include <cstdint>

#include "base/worker_pool.h"
#include "retime/blend_kernels.h"
#include "retime/draw_kernels.h"
#include "retime/moved_surfaces.h"
#include "sweep/aligned_array.h"

namespace viewloom {

// One layer at a time, front to back; of each row its fresh columns (MovedSurfaces). The nearest
// wins by the maximum of 64 bits, 1/Z before the number of the piece of surface: whatever threads
// draw in whatever order, the answer is the same.
// Thread-safety: none; it shares its work among threads.
class FreshGrid {
 public:
  // Draws the layer behind one, of which `in_front` is [px], 1/m, abi::kNoSurface where nothing is;
  // nullptr: the layer in front. `surfaces` stay as they are until it is no longer asked.
  void draw(const MovedSurfaces& surfaces, const float* in_front, WorkerPool& workers);

  // Fills in the drawn surfaces at fresh columns of a row.
  void findRow(uint32_t y, BlendedRow& row) const;

 private:
  void drawRow(uint32_t y);
  void drawFootprint(uint32_t layer, uint32_t x, uint32_t y);
  void offer(uint32_t px, uint64_t key);

  const MovedSurfaces* surfaces_ = nullptr;
  const float* in_front_ = nullptr;
  AlignedArray<uint64_t> nearest_;  // [px], pieceKey(); 0: nothing
};

}  // namespace viewloom
