// SPDX-License-Identifier: Apache-2.0
#include "bench/cpu/ray_packet.h"

#include <algorithm>
#include <bit>

namespace viewloom::bench {
namespace {

constexpr int kLanes = int(kPacketSize);

}  // namespace

bool raysLookAhead(const BenchLoad& load) {
  const SizePx tile_px = load.job.layout->tile_size_px;
  return std::all_of(load.job.tiles.begin(), load.job.tiles.end(), [&](const auto& tile) {
    const float across = float(tile_px.width) * tile.direction_dx.z;
    const float down = float(tile_px.height) * tile.direction_dy.z;
    return tile.direction.z + std::min(across, 0.0F) + std::min(down, 0.0F) > 0;
  });
}

uint32_t packetViews(uint32_t view_count) {
  return std::bit_floor(std::min(view_count, kPacketSize));
}

RayPacket::RayPacket(const BenchLoad& load, uint32_t first_view, uint32_t row) {
  const AtlasLayout& layout = *load.job.layout;
  const uint32_t view_count = packetViews(uint32_t(load.job.tiles.size()));
  column_count = kPacketSize / view_count;
  width_px = layout.tile_size_px.width;
  const float near_inv_z = std::max(load.source.inv_z_max * kNearMargin, abi::kInvZNearMin);
  for (uint32_t lane = 0; lane < kPacketSize; ++lane) {
    const uint32_t view = first_view + lane % view_count;
    has_view_[lane] = view < load.job.tiles.size();
    const abi::ViewParams& tile = load.job.tiles[has_view_[lane] ? view : first_view];
    column_[lane] = int(lane / view_count);
    offset_px[lane] =
        (layout.padding_top_px + size_t{view / layout.columns} * layout.tile_size_px.height + row) *
            layout.size_px.width +
        size_t{view % layout.columns} * width_px + lane / view_count;
    // Surfaces behind the eye are invisible.
    const float from = tile.eye.z * near_inv_z > 1 ? 1 / tile.eye.z : near_inv_z;
    from_inv_z[lane] = from;
    eye_x_[lane] = tile.eye.x * from;
    eye_y_[lane] = tile.eye.y * from;
    eye_z_[lane] = 1 - tile.eye.z * from;
    const abi::vec3 start =
        tile.direction + 0.5F * tile.direction_dx + (float(row) + 0.5F) * tile.direction_dy;
    start_x_[lane] = start.x;
    start_y_[lane] = start.y;
    start_z_[lane] = start.z;
    step_x_[lane] = tile.direction_dx.x;
    step_y_[lane] = tile.direction_dx.y;
    step_z_[lane] = tile.direction_dx.z;
  }
}

void RayPacket::aim(uint32_t column) {
  const int first = int(column);
  const int end = int(width_px);
#pragma omp simd
  for (int lane = 0; lane < kLanes; ++lane) {
    const int here = first + column_[lane];
    is_active[lane] = has_view_[lane] && here < end ? -1 : 0;
    const float across = float(here);
    // The point at infinity, and that at from_inv_z: inv_z eye + (1 - inv_z eye.z) of the former.
    const float scale = 1 / (start_z_[lane] + across * step_z_[lane]);
    const float far_x = (start_x_[lane] + across * step_x_[lane]) * scale;
    const float far_y = (start_y_[lane] + across * step_y_[lane]) * scale;
    from_x[lane] = eye_x_[lane] + eye_z_[lane] * far_x;
    from_y[lane] = eye_y_[lane] + eye_z_[lane] * far_y;
    along_x[lane] = far_x - from_x[lane];
    along_y[lane] = far_y - from_y[lane];
  }
}

void PacketColors::blend() {
#pragma omp simd
  for (int lane = 0; lane < kLanes; ++lane) {
    const float x = clampTo(right[lane], 0, 1);
    const float y = clampTo(down[lane], 0, 1);
    const uint32_t a = rgba[0][lane];
    const uint32_t b = rgba[1][lane];
    const uint32_t c = rgba[2][lane];
    const uint32_t d = rgba[3][lane];
    const auto channel = [=](uint32_t shift) {
      const float top = codeAt(a, shift) + x * (codeAt(b, shift) - codeAt(a, shift));
      const float bottom = codeAt(c, shift) + x * (codeAt(d, shift) - codeAt(c, shift));
      return uint32_t(int(top + y * (bottom - top) + 0.5F)) << shift;
    };
    blended[lane] = kOpaqueCode | channel(0) | channel(8) | channel(16);
  }
}

}  // namespace viewloom::bench
