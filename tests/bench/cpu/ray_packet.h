// SPDX-License-Identifier: Apache-2.0
// Rays by the packet: as many views of one px as there are, because views lie closer to each other
// in the source than the px of one.
#pragma once

#include <cstddef>
#include <cstdint>

#include "bench/bench_load.h"
#include "bench/cpu/light.h"

namespace viewloom::bench {

inline constexpr uint32_t kPacketSize = 16;
// Rays begin a little in front of the nearest surface and end a little behind the sky.
inline constexpr float kNearMargin = 1.0001F;
inline constexpr float kFarMargin = 1.0001F;

// Whether inv_z falls along all rays of a load.
bool raysLookAhead(const BenchLoad& load);
uint32_t packetViews(uint32_t view_count);

// Lanes are the views from `first_view` on, times some columns of a tile's row. A ray's point at t
// in 0..1 is from + t * along, and its inv_z is from_inv_z * (1 - t).
struct RayPacket {
  RayPacket(const BenchLoad& load, uint32_t first_view, uint32_t row);
  // At the columns from `column` on.
  void aim(uint32_t column);

  alignas(64) float from_x[kPacketSize];
  alignas(64) float from_y[kPacketSize];
  alignas(64) float from_inv_z[kPacketSize];
  alignas(64) float along_x[kPacketSize];
  alignas(64) float along_y[kPacketSize];
  alignas(64) int is_active[kPacketSize];  // 0 or -1
  size_t offset_px[kPacketSize];           // in the atlas, of column 0
  uint32_t column_count = 1;
  uint32_t width_px = 0;

 private:
  // In homogeneous px: the direction of column 0, its change, and the eye at from_inv_z.
  alignas(64) float start_x_[kPacketSize];
  alignas(64) float start_y_[kPacketSize];
  alignas(64) float start_z_[kPacketSize];
  alignas(64) float step_x_[kPacketSize];
  alignas(64) float step_y_[kPacketSize];
  alignas(64) float step_z_[kPacketSize];
  alignas(64) float eye_x_[kPacketSize];
  alignas(64) float eye_y_[kPacketSize];
  alignas(64) float eye_z_[kPacketSize];
  alignas(64) int column_[kPacketSize];
  bool has_view_[kPacketSize];
};

// Four colours and where between them, for each ray.
struct PacketColors {
  void setOne(uint32_t lane, uint32_t color) {
    rgba[0][lane] = rgba[1][lane] = rgba[2][lane] = rgba[3][lane] = color;
    right[lane] = down[lane] = 0;
  }
  void setFour(uint32_t lane, const uint32_t* top_left, int width_px, float x, float y) {
    rgba[0][lane] = top_left[0];
    rgba[1][lane] = top_left[1];
    rgba[2][lane] = top_left[width_px];
    rgba[3][lane] = top_left[width_px + 1];
    right[lane] = x;
    down[lane] = y;
  }
  void blend();

  alignas(64) uint32_t blended[kPacketSize];
  alignas(64) uint32_t rgba[4][kPacketSize];
  alignas(64) float right[kPacketSize];
  alignas(64) float down[kPacketSize];
};

}  // namespace viewloom::bench
