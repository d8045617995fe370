// SPDX-License-Identifier: Apache-2.0
// Messages of the protocol from JSON that users and web clients write (protobuf's JSON mapping).
#pragma once

#include <cstddef>
#include <string_view>

#include <google/protobuf/message.h>

#include "base/status.h"

namespace viewloom {

// Fills the message. INVALID_ARGUMENT for a text that is too long, no JSON, or not of this message:
// unknown names, values of another type, a field that came twice. Names are those of the protos, or
// the same in camelCase. Errors name the field inside the message ("quilt.columns").
absl::Status messageFromJson(std::string_view text, size_t bytes_max,
                             google::protobuf::Message& message);

}  // namespace viewloom
