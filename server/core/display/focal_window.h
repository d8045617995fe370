// SPDX-License-Identifier: Apache-2.0
// The rectangle on the focal plane that all views of a display frame, and cameras that look through
// it.
#pragma once

#include "display/atlas_layout.h"

namespace viewloom {

// Axis-aligned, at distance_m in front of the display's origin, perpendicular to its view axis.
struct FocalWindow {
  glm::dvec2 center_m{0.0};  // x right, y up
  glm::dvec2 half_size_m{1.0};
  double distance_m = 1;
};

// The distance a display asks for, or the stream's where it asks for none.
double focalDistance(double wanted_m, const StreamDefaults& defaults);

// fov_y_rad > 0: centred on the view axis, 2 * distance * tan(fov_y / 2) high. fov_y_rad = 0: what
// the source sees at that distance, cropped around its middle to the aspect, so that a view from
// the source's own position asks for nothing that the source lacks.
FocalWindow focalWindow(double distance_m, double fov_y_rad, double aspect,
                        const StreamDefaults& defaults);

// The off-axis pinhole at eye_m, looking along -z, whose tile shows exactly the window. Expects an
// eye in front of it: z > -distance_m.
// Tile pixels need not be square: a tile of another shape than the window is stretched
// (anamorphic).
Camera cameraThroughWindow(const FocalWindow& window, const glm::dvec3& eye_m, SizePx tile_size_px);

}  // namespace viewloom
