// SPDX-License-Identifier: Apache-2.0
// What a frame may be → proto PublishAccepted.
#pragma once

#include "frame/limits.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom {

v1::PublishAccepted limitsToProto(const FrameLimits& limits);

}  // namespace viewloom
