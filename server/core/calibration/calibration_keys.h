// SPDX-License-Identifier: Apache-2.0
// Reads single values of a calibration file, and says what is wrong with them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "base/status.h"

namespace viewloom {

// A refusal that says how to get a file that is whole.
absl::Status refuseKey(std::string_view key, std::string_view problem);

struct NumberKey {
  const char* name;
  double min;
  double max;
  std::optional<double> fallback = std::nullopt;  // where the key is absent; none: it must be there
  bool is_whole = false;
};

// The number at the key, plain or as {"value": x}. INVALID_ARGUMENT names the key.
absl::StatusOr<double> readNumber(const nlohmann::json& object, const NumberKey& key);

// The text at the key, plain or as {"value": "x"}; empty where it is absent.
absl::StatusOr<std::string> readText(const nlohmann::json& object, const char* key);

// What came, short enough for a sentence.
std::string describeJson(const nlohmann::json& value);

}  // namespace viewloom
