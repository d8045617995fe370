// SPDX-License-Identifier: Apache-2.0
// Checks the declaration of one plane.
#pragma once

#include <cstdint>
#include <string>

#include "base/status.h"
#include "frame/frame.h"

namespace viewloom {

// "640x480"
std::string sizeText(SizePx size_px);

// Errors name a field of the plane ("size"). INVALID_ARGUMENT for impossible values,
// RESOURCE_EXHAUSTED for a side over `side_px_max`, UNIMPLEMENTED for what is not served yet.
absl::Status validatePlane(const PlaneFormat& plane, PlaneKind kind, bool is_cube_map,
                           uint32_t side_px_max);

}  // namespace viewloom
