// SPDX-License-Identifier: Apache-2.0
// proto TemporalEffect → TemporalSpec.
#pragma once

#include "base/status.h"
#include "display/temporal_spec.h"
#include "viewloom/v1/effects.pb.h"

namespace viewloom {

// Its ranges are checked with the display's (completeDisplaySpec). Errors name the field relative
// to the message.
absl::StatusOr<TemporalSpec> temporalFromProto(const v1::TemporalEffect& proto);

}  // namespace viewloom
