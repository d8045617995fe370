// SPDX-License-Identifier: Apache-2.0
#include "picture/ray_count.h"

#include <algorithm>
#include <variant>

#include "display/rgbd.h"

namespace viewloom {
namespace {

int64_t rayCount(const QuiltSpec& quilt) {
  return int64_t(quilt.size_px.area());
}
int64_t rayCount(const StereoSpec& stereo) {
  return 2 * int64_t(stereo.eye_size_px.area());
}
int64_t rayCount(const CamerasSpec& cameras) {
  const size_t count = cameras.grid ? cameras.grid->count() : cameras.cameras.size();
  return int64_t(count * cameras.tile_size_px.area());
}
int64_t rayCount(const LenticularSpec& lenticular) {
  return 3 * int64_t(lenticular.calibration->screen_px.area());
}
int64_t rayCount(const IntegralSpec& integral) {
  return int64_t(integral.panel_px.area());
}
int64_t rayCount(const RgbdSpec& rgbd) {
  const TileGrid grid = tileGrid(rgbd);
  return int64_t(grid.width_px * grid.height_px);
}

}  // namespace

int64_t rayCount(const DisplaySpec& spec) {
  const int64_t px_count = std::visit([](const auto& kind) { return rayCount(kind); }, spec.kind);
  const uint32_t of_lens = spec.lens ? spec.lens->walked_count : 1;
  return px_count * std::max(spec.filter.sample_count, of_lens);
}

}  // namespace viewloom
