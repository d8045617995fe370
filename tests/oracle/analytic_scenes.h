// SPDX-License-Identifier: Apache-2.0
// Scenes whose every answer is known in closed form.
#pragma once

#include <optional>

#include "oracle/scene_generator.h"
#include "oracle/view_generator.h"

namespace viewloom::oracle {

// inv_z = along_x x + along_y y + at_origin over the image, 1/m and px. Multiples of 2^-12 keep
// samples and slopes exact in binary32.
struct ImagePlane {
  double along_x = 0;
  double along_y = 0;
  double at_origin = 0;

  double invZ(double x_px, double y_px) const {
    return along_x * x_px + along_y * y_px + at_origin;
  }
};

// One plane that fills the image.
Scene planeScene(const ImagePlane& plane, int width, int height);

// `near` fills the columns from `first_near_column` on; `far` fills the others, and as layer 1 also
// continues behind `near` when asked to.
Scene stepScene(const ImagePlane& near, const ImagePlane& far, int first_near_column,
                bool far_continues, int width, int height);

// Where a ray meets a plane that reaches to infinity on all sides, from three metric points of it.
std::optional<glm::dvec3> meet(const ImagePlane& plane, const Pinhole& pinhole, const Ray& ray);

// Image position in px and 1/Z of a point before the camera.
glm::dvec3 imageOf(const Pinhole& pinhole, const glm::dvec3& point_m);

}  // namespace viewloom::oracle
