// SPDX-License-Identifier: Apache-2.0
// The camera that Unreal's Movie Render Queue writes into EXR headers.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "base/status.h"
#include "viewloom/v1/geometry.pb.h"

namespace viewloom::inputs {

// Reads unreal/camera/curPos/{x,y,z} (cm), unreal/camera/curRot/{pitch,yaw,roll} (degrees) and
// fov (degrees across the width), or focalLength and sensorWidth (mm), of any camera's name, as
// unreal/camera/FinalImage/fov. Unreal's world is left-handed with x forward, y right and z up; it
// becomes x right, y up and -z forward, in metres. Nothing when there is neither a place nor a
// field of view; INVALID_ARGUMENT when one of the texts is no number that can be.
absl::StatusOr<std::optional<v1::Camera>> unrealCamera(
    const std::string& file, const std::map<std::string, std::string>& texts, double width_px,
    double height_px, double pixel_aspect);

}  // namespace viewloom::inputs
