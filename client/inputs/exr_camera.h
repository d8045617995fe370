// SPDX-License-Identifier: Apache-2.0
// The camera that the matrices of an OpenEXR header state.
#pragma once

#include <optional>
#include <string>

#include "base/status.h"
#include "files/exr_description.h"
#include "viewloom/v1/geometry.pb.h"

namespace viewloom::inputs {

struct ExrCameraOptions {
  double width_px = 0;  // of the display window
  double height_px = 0;
  double metres_per_unit = 1;
  // worldToCamera leads to +x right, +y up and +z forward, as OpenEXR says; or, as some tools write
  // it, to -z forward.
  bool looks_along_minus_z = false;
};

struct ExrCamera {
  v1::Pose pose;
  // From worldToNDC; its range is 0..1 from the upper left corner, as OpenEXR says, or, as some
  // tools write it, -1..1 from the lower left: then the axis meets the image at about 0, 0.
  std::optional<v1::Intrinsics> intrinsics;
};

// Vectors are rows. A world of the other handedness than the camera's is taken to be right-handed
// when the camera is left-handed, and the other way round; a left-handed world has its z turned
// over. Nothing without worldToCamera; INVALID_ARGUMENT when a matrix is no camera's.
absl::StatusOr<std::optional<ExrCamera>> exrCamera(const std::string& file,
                                                   const files::ExrDescription& description,
                                                   const ExrCameraOptions& options);

}  // namespace viewloom::inputs
