// SPDX-License-Identifier: Apache-2.0
#include "picture/lens_bounds.h"

#include <algorithm>

namespace viewloom {

Camera fromLensCorner(const Camera& camera, const AtlasLayout& layout, glm::dvec2 corner) {
  const double focus_m = layout.distanceOf(layout.lens->focus_m, {camera});
  return sampledCamera(camera, {.eye_m = corner * layout.lens->radius_m}, focus_m);
}

void addLens(const TraceJob& job, const Pose& display_pose, const Camera& source, SizePx source_px,
             const View& view, abi::ViewParams& tile) {
  const AtlasLayout& layout = *job.layout;
  tile.lens_px_m = abi::vec2(layout.lens->radius_m * view.camera.intrinsics.focal_px);
  tile.lens_inv_focus = float(1 / layout.distanceOf(layout.lens->focus_m, view));
  for (const glm::dvec2 corner : kLensCorners) {
    const abi::ViewParams seen_from =
        makeViewParams({fromLensCorner(view.camera, layout, corner)}, display_pose, source,
                       source_px, job.tolerance_px);
    tile.inv_z_tolerance = std::min(tile.inv_z_tolerance, seen_from.inv_z_tolerance);
  }
}

void addLensBounds(TraceJob& job, const Pose& display_pose, const Camera& source,
                   SizePx source_px) {
  const AtlasLayout& layout = *job.layout;
  for (uint32_t tile = 0; tile < layout.columns * layout.rows; ++tile) {
    const uint32_t index = layout.viewAt(tile % layout.columns, tile / layout.columns);
    for (const glm::dvec2 corner : kLensCorners) {
      job.lens_bounds.push_back(
          index < layout.views.size()
              ? makeViewParams({fromLensCorner(layout.views[index].camera, layout, corner)},
                               display_pose, source, source_px, job.tolerance_px)
              : abi::ViewParams{});
    }
  }
}

}  // namespace viewloom
