// SPDX-License-Identifier: Apache-2.0
// What a display with an output rate is shown at a time.
#pragma once

#include "display/display_spec.h"
#include "temporal/camera_motion.h"

namespace viewloom {

// At `server_ns` of the server's clock, as spec.temporal asks for, which it needs. A display in the
// world sees the same whatever the camera does.
ShownInstant shownTo(const DisplaySpec& spec, const CameraMotion& motion, int64_t server_ns);

}  // namespace viewloom
