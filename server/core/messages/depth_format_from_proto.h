// SPDX-License-Identifier: Apache-2.0
// What the samples of a depth plane measure, as it is sent → DepthFormat.
#pragma once

#include "base/status.h"
#include "frame/depth.h"
#include "viewloom/v1/frame.pb.h"

namespace viewloom {

// Every default is filled in; refuses an unknown meaning. Errors name the field ("meaning"). The
// numbers are left to validateDepthFormat.
absl::StatusOr<DepthFormat> depthFormatFromProto(const v1::DepthFormat& proto);

}  // namespace viewloom
