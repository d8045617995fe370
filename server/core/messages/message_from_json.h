// SPDX-License-Identifier: Apache-2.0
// Reads messages of the protocol from JSON of users and web clients (protobuf's JSON mapping).
#pragma once

#include <cstddef>
#include <string_view>

#include <google/protobuf/message.h>

#include "base/status.h"

namespace viewloom {

// Fills the message. Names are those of the protos, or the same in camelCase. INVALID_ARGUMENT for
// a text that is too long or not JSON, for unknown names, for values of another type, and for a
// field that is given twice. Errors name the field inside the message ("quilt.columns").
absl::Status messageFromJson(std::string_view text, size_t bytes_max,
                             google::protobuf::Message& message);

}  // namespace viewloom
