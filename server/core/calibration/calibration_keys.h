// SPDX-License-Identifier: Apache-2.0
// Reads single values of a calibration file, with errors for users.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "base/status.h"

namespace viewloom {

// An error that says how to get a complete file.
absl::Status refuseKey(std::string_view key, std::string_view problem);

struct NumberKey {
  const char* name;
  double min;
  double max;
  std::optional<double> fallback = std::nullopt;  // for an absent key; none: the key is required
  bool is_whole = false;
};

// Reads the number of a key, plain or as {"value": x}. INVALID_ARGUMENT names the key.
absl::StatusOr<double> readNumber(const nlohmann::json& object, const NumberKey& key);

// Reads the text of a key, plain or as {"value": "x"}; empty if the key is absent.
absl::StatusOr<std::string> readText(const nlohmann::json& object, const char* key);

// Text of a JSON value, short enough for a sentence.
std::string describeJson(const nlohmann::json& value);

}  // namespace viewloom
