// SPDX-License-Identifier: Apache-2.0
// A display as a client asks for it → a completed DisplaySpec.
#pragma once

#include "base/status.h"
#include "display/display_spec.h"
#include "viewloom/v1/display.pb.h"

namespace viewloom {

// Refuses unknown and later fields, then completes and checks the spec. Errors name the field as in
// proto Display ("quilt.columns").
absl::StatusOr<DisplaySpec> displayFromProto(const v1::Display& proto);

}  // namespace viewloom
