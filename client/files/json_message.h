// SPDX-License-Identifier: Apache-2.0
// Messages of the protocol from JSON files that users write.
#pragma once

#include <google/protobuf/message.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/status.h"

namespace viewloom::files {

// Fills the message. `what` is the file's content in a user's words: "a display". The refusal says
// what the JSON reader found, in one line.
absl::Status readJsonMessage(const std::filesystem::path& path, uint64_t bytes_max,
                             const std::string& what, google::protobuf::Message& message);

}  // namespace viewloom::files
