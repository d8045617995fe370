// SPDX-License-Identifier: Apache-2.0
#include "picture/ray_count.h"

#include <algorithm>

#include "display/atlas_layout.h"

namespace viewloom {

int64_t rayCount(const DisplaySpec& spec) {
  const TileGrid grid = tileGridOf(spec);
  const uint32_t of_lens = spec.lens ? spec.lens->walked_count : 1;
  return int64_t(grid.width_px * grid.height_px * grid.rays_per_px) *
         std::max(spec.filter.sample_count, of_lens);
}

}  // namespace viewloom
