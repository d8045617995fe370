// SPDX-License-Identifier: Apache-2.0
// Rights as JSON: {"roles": ["watch"], "streams": ["room.*"], "limits": {"displays": 4}}. Lines of
// the token file and claims of a JWT are written alike.
#pragma once

#include <nlohmann/json.hpp>

#include "access/rights.h"

namespace viewloom {

// Reads the three fields and ignores others. `roles` and `streams` may also be one text.
// INVALID_ARGUMENT names the field.
absl::StatusOr<Rights> rightsFromJson(const nlohmann::json& object);

// Adds the three fields; `limits` only if there are some.
void addRights(const Rights& rights, nlohmann::ordered_json& object);

}  // namespace viewloom
