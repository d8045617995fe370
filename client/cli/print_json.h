// SPDX-License-Identifier: Apache-2.0
// Answers of the server for programs.
#pragma once

#include <google/protobuf/message.h>

#include <string>

#include "base/status.h"

namespace viewloom::cli {

// On stdout, as JSON with every field.
absl::Status printJson(const google::protobuf::Message& message);

// In one line, of the fields that are set: to be sent. Expects numbers that are finite.
std::string compactJson(const google::protobuf::Message& message);

}  // namespace viewloom::cli
