// SPDX-License-Identifier: Apache-2.0
// A frame header as a publisher sends it → FrameFormat, every default filled in.
#pragma once

#include "base/status.h"
#include "frame/frame.h"
#include "frame/limits.h"
#include "viewloom/v1/frame.pb.h"

namespace viewloom {

// Refuses unknown and later fields and wrong sets of planes; the result has passed validateFrame.
// Errors name the field as in proto PublishFramesRequest
// ("header.sources[0].layers[1].planes[0].kind").
absl::StatusOr<FrameFormat> frameFormatFromProto(const v1::FrameHeader& proto,
                                                 const FrameLimits& limits);

}  // namespace viewloom
