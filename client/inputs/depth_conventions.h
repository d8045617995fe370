// SPDX-License-Identifier: Apache-2.0
// Depth by the conventions of those who write it: renderers with any sign and huge numbers where
// they hit nothing, sensors and data sets with units of their own.
#pragma once

#include <string>
#include <vector>

#include "base/byte_pool.h"
#include "base/status.h"
#include "inputs/input_settings.h"
#include "inputs/interpretation.h"

namespace viewloom::inputs {

// Arnold, V-Ray, Redshift and Houdini.
bool isRenderer(InputKind kind);

// Metric depth of floats, as far as the settings do not say it: depth that is negative is turned
// over, and what is 1e9 and more, as 1e30, becomes infinitely far. `notes`: what was found.
void settleRendererDepth(const InputSettings& settings, v1::Plane& plane, SharedBytes& bytes,
                         std::vector<std::string>& notes);

// Whether the kind is one of these: sensor, kitti, tum, l515, d405, record3d.
bool isSensor(InputKind kind);

// The format of the kind's depth: 0 is nothing measured, and the unit of a whole number is
//   sensor 1 mm, kitti 1 / 256 m (with a baseline: 1 / 256 px of disparity), tum 1 / 5000 m,
//   l515 0.25 mm, d405 0.1 mm, record3d 1 mm (floats: metres, settled by settleRecord3d)
v1::DepthFormat sensorFormat(const InputSettings& settings, InputKind kind);

// Floats of Record3D are metres.
void settleRecord3d(const InputSettings& settings, bool is_float, v1::DepthFormat& format);

// Turns a format of disparity in px of two cameras `baseline_m` apart into 1/m: 1/Z = d / (f b).
void settleBaseline(double focal_px, double baseline_m, v1::DepthFormat& format);

}  // namespace viewloom::inputs
