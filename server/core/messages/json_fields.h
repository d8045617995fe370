// SPDX-License-Identifier: Apache-2.0
// Checks that JSON names fields of a message, each once and with a value of its type.
#pragma once

#include <string_view>

#include <google/protobuf/descriptor.h>

#include "base/status.h"

namespace viewloom {

// Checks a text in one pass, with memory for one path. Errors name the field inside the message
// ("quilt.columns"), what was given and what is accepted. For an unknown name they list the known
// ones. protobuf's own reader checks numbers that are within their type.
absl::Status checkJsonFields(std::string_view text, const google::protobuf::Descriptor& type);

}  // namespace viewloom
