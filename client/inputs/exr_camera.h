// SPDX-License-Identifier: Apache-2.0
// The camera that an OpenEXR header states: in matrices, or as Unreal's Movie Render Queue writes
// it.
#pragma once

#include <map>
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

// Reads unreal/camera/curPos/{x,y,z} (cm), unreal/camera/curRot/{pitch,yaw,roll} (degrees) and
// fov (degrees across the width), or focalLength and sensorWidth (mm), of any camera's name, as
// unreal/camera/FinalImage/fov. Unreal's world is left-handed with x forward, y right and z up; it
// becomes x right, y up and -z forward, in metres. Nothing when there is neither a place nor a
// field of view; INVALID_ARGUMENT when one of the texts is no number that can be.
absl::StatusOr<std::optional<v1::Camera>> unrealCamera(
    const std::string& file, const std::map<std::string, std::string>& texts, double width_px,
    double height_px, double pixel_aspect);

}  // namespace viewloom::inputs
