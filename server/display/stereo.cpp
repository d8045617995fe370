// SPDX-License-Identifier: Apache-2.0
#include "display/stereo.h"

#include "display/camera_list.h"
#include "display/focal_window.h"

namespace viewloom {

std::vector<View> stereoViews(const StereoSpec& stereo, const StreamDefaults& defaults) {
  if (!stereo.eyes.empty()) return cameraViews(stereo.eyes, stereo.eye_size_px);
  const double aspect = double{1} * stereo.eye_size_px.width / stereo.eye_size_px.height;
  const FocalWindow window = focalWindow(focalDistance(stereo.focal_distance_m, defaults),
                                         stereo.fov_y_rad, aspect, defaults);
  const double half_m = stereo.eye_distance_m / 2;
  return {{cameraThroughWindow(window, -half_m, stereo.eye_size_px)},
          {cameraThroughWindow(window, half_m, stereo.eye_size_px)}};
}

}  // namespace viewloom
