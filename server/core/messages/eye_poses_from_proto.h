// SPDX-License-Identifier: Apache-2.0
// Where a client says the eyes before its display are → EyePoses, checked.
#pragma once

#include "base/status.h"
#include "display/tracked_eyes.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom {

// Poses of a tracked display with so many eyes. Errors name the field as
// "eye_poses.eyes[1].pose.position". Whether the eyes stand in front of the focal plane is not
// known here.
absl::StatusOr<EyePoses> eyePosesFromProto(const v1::EyePoses& proto, size_t eye_count);

}  // namespace viewloom
