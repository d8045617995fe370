// SPDX-License-Identifier: Apache-2.0
#include "support/forward_map.h"

#include <algorithm>
#include <cmath>

namespace viewloom::test {

InvZImage forwardMap(const InvZImage& source, const Intrinsics& source_camera, const Camera& view,
                     SizePx view_size_px) {
  InvZImage mapped = {.size_px = view_size_px, .inv_z = {}};
  mapped.inv_z.assign(view_size_px.area(), -1.0F);
  const glm::dquat view_from_source = glm::inverse(view.pose.orientation);
  for (uint32_t y = 0; y < source.size_px.height; ++y) {
    for (uint32_t x = 0; x < source.size_px.width; ++x) {
      const double inv_z = source.inv_z[size_t{y} * source.size_px.width + x];
      if (inv_z < 0) continue;
      // The point divided by its own distance, so that infinitely far points are points as well.
      const glm::dvec3 ray((x + 0.5 - source_camera.principal_px.x) / source_camera.focal_px.x,
                           -(y + 0.5 - source_camera.principal_px.y) / source_camera.focal_px.y,
                           -1.0);
      const glm::dvec3 point = view_from_source * (ray - inv_z * view.pose.position_m);
      if (point.z >= 0) continue;
      const Intrinsics& k = view.intrinsics;
      const double u = std::floor(k.principal_px.x + k.focal_px.x * point.x / -point.z);
      const double v = std::floor(k.principal_px.y - k.focal_px.y * point.y / -point.z);
      if (u < 0 || v < 0 || u >= view_size_px.width || v >= view_size_px.height) continue;
      float& kept =
          mapped.inv_z[static_cast<size_t>(v) * view_size_px.width + static_cast<size_t>(u)];
      kept = std::max(kept, static_cast<float>(inv_z / -point.z));
    }
  }
  return mapped;
}

std::vector<uint8_t> coveredMask(const InvZImage& mapped) {
  std::vector<uint8_t> mask(mapped.inv_z.size());
  std::transform(mapped.inv_z.begin(), mapped.inv_z.end(), mask.begin(),
                 [](float inv_z) { return inv_z < 0 ? uint8_t{0} : uint8_t{255}; });
  return mask;
}

}  // namespace viewloom::test
