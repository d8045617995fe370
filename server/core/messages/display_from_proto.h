// SPDX-License-Identifier: Apache-2.0
// Converts a display and the encoding of its atlases from proto to DisplaySpec and EncodingSpec,
// completed and checked.
#pragma once

#include "base/status.h"
#include "display/display_spec.h"
#include "viewloom/v1/atlas.pb.h"
#include "viewloom/v1/display.pb.h"

namespace viewloom {

// Refuses unknown values and values that are not served yet, then completes and checks the spec.
// Errors name the field as in proto Display ("quilt.columns").
absl::StatusOr<DisplaySpec> displayFromProto(const v1::Display& proto);

// Converts an encoding and fills in every default. Expects a completed display. Errors name the
// field as in proto AtlasEncoding.
absl::StatusOr<EncodingSpec> encodingFromProto(const v1::AtlasEncoding& proto,
                                               const DisplaySpec& display);

}  // namespace viewloom
