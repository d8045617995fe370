// SPDX-License-Identifier: Apache-2.0
// Colour with depth, asked for by the parameters of a URL.
#pragma once

#include <span>

#include "base/status.h"
#include "display/display_spec.h"
#include "web/url.h"
#include "web/watch_parameters.h"

namespace viewloom {

// Parameters that colour with depth accepts.
std::span<const ParameterField> rgbdParameters();

// rgbd (color-depth, two-layers), preset, width and height of a view, near_m, far_m, screen_m,
// depth_side (right, left, top, bottom), black_near (0, 1), fov_deg. Not completed.
// INVALID_ARGUMENT names the parameter.
absl::StatusOr<RgbdSpec> readRgbd(const QueryParameters& parameters);

}  // namespace viewloom
