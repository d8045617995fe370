// SPDX-License-Identifier: Apache-2.0
// Choice of an encoding among those that a client can decode.
#pragma once

#include <google/protobuf/repeated_ptr_field.h>

#include "base/status.h"
#include "display/display_spec.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom {

using AcceptedEncodings = google::protobuf::RepeatedPtrField<v1::AcceptedEncoding>;

// The encoding that serves the display, with every default: `asked`, and if it leaves color open,
// with the first accepted color that the display and the client's limits allow. Without accepted
// ones, as encodingFromProto says. INVALID_ARGUMENT with the field "accepted" if none serves, or if
// there are more than 32; other errors name the field as "encoding.color".
absl::StatusOr<EncodingSpec> chooseEncoding(const v1::AtlasEncoding& asked,
                                            const AcceptedEncodings& accepted,
                                            const DisplaySpec& display);

}  // namespace viewloom
