// SPDX-License-Identifier: Apache-2.0
// Rectangle on the focal plane that all views of a display frame, and cameras that look through it.
#pragma once

#include "display/atlas_layout.h"

namespace viewloom {

// A window perpendicular to the view axis of the display, at distance_m in front of its origin.
struct FocalWindow {
  glm::dvec2 center_m{0.0};  // x right, y up
  glm::dvec2 half_size_m{1.0};
  double distance_m = 1;
};

// Distance that a display asks for, or the stream's if it asks for none.
double focalDistance(double wanted_m, const StreamDefaults& defaults);

// Window of a display. With fov_y_rad > 0 it is centred on the view axis and
// 2 * distance * tan(fov_y / 2) high. With 0 it is the rectangle that the source sees at that
// distance, cropped around its middle to the aspect. A view from the position of the source then
// needs nothing that the source lacks.
FocalWindow focalWindow(double distance_m, double fov_y_rad, double aspect,
                        const StreamDefaults& defaults);

// Off-axis pinhole camera at eye_m that looks along -z and whose tile shows exactly the window.
// Expects an eye in front of the window: z > -distance_m. Pixels of a tile need not be square: a
// tile of another shape than the window is stretched (anamorphic).
Camera cameraThroughWindow(const FocalWindow& window, const glm::dvec3& eye_m, SizePx tile_size_px);

}  // namespace viewloom
