// SPDX-License-Identifier: Apache-2.0
// Reads JSON objects that decide about access.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/status.h"

namespace viewloom {

// INVALID_ARGUMENT for texts that are no JSON object, or that give a field twice: other readers
// might take the other one. The message never quotes the text.
absl::StatusOr<nlohmann::json> parseJsonObject(std::string_view text);

// The text of a field; "" if it is missing. INVALID_ARGUMENT for other types.
absl::StatusOr<std::string> textField(const nlohmann::json& object, const char* field);

}  // namespace viewloom
