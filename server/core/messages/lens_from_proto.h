// SPDX-License-Identifier: Apache-2.0
// proto LensEffect → LensSpec, as it came; completeDisplaySpec() checks it.
#pragma once

#include "base/status.h"
#include "display/lens.h"
#include "viewloom/v1/effects.pb.h"

namespace viewloom {

// Errors name the field as "effects.lens.mode".
absl::StatusOr<LensSpec> lensFromProto(const v1::LensEffect& proto);
// INVALID_ARGUMENT for a number that no quality has.
absl::StatusOr<Quality> qualityFromProto(v1::Quality proto);

}  // namespace viewloom
