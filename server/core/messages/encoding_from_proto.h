// SPDX-License-Identifier: Apache-2.0
// How a client wants its atlases packed → EncodingSpec, every default filled in and checked.
#pragma once

#include "base/status.h"
#include "display/display_spec.h"
#include "viewloom/v1/atlas.pb.h"

namespace viewloom {

// The display is completed. Errors name the field as in proto AtlasEncoding.
absl::StatusOr<EncodingSpec> encodingFromProto(const v1::AtlasEncoding& proto,
                                               const DisplaySpec& display);

}  // namespace viewloom
