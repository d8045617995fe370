// SPDX-License-Identifier: Apache-2.0
// Whether JSON names the fields of a message, each once and with a value of its type.
#pragma once

#include <string_view>

#include <google/protobuf/descriptor.h>

#include "base/status.h"

namespace viewloom {

// Reads the text once, with memory for one path. Errors name the field inside the message
// ("quilt.columns"), what came, and what is accepted; for an unknown name, the names that there
// are. Numbers are left to protobuf's own reader where they are within their type.
absl::Status checkJsonFields(std::string_view text, const google::protobuf::Descriptor& type);

}  // namespace viewloom
