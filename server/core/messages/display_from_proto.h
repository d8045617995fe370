// SPDX-License-Identifier: Apache-2.0
// A display as a client asks for it, and the packing of its atlases → DisplaySpec and EncodingSpec,
// completed and checked.
#pragma once

#include "base/status.h"
#include "display/display_spec.h"
#include "viewloom/v1/atlas.pb.h"
#include "viewloom/v1/display.pb.h"

namespace viewloom {

// Refuses unknown and later fields, then completes and checks the spec. Errors name the field as in
// proto Display ("quilt.columns").
absl::StatusOr<DisplaySpec> displayFromProto(const v1::Display& proto);

// Every default is filled in. The display is completed. Errors name the field as in proto
// AtlasEncoding.
absl::StatusOr<EncodingSpec> encodingFromProto(const v1::AtlasEncoding& proto,
                                               const DisplaySpec& display);

}  // namespace viewloom
