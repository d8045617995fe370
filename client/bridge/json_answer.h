// SPDX-License-Identifier: Apache-2.0
// JSON as other programs answer it.
#pragma once

#include <string_view>

#include <nlohmann/json.hpp>

#include "base/json_nesting.h"

namespace viewloom::bridge {

// Discarded where the text is no JSON, or nests too deeply to be walked.
inline nlohmann::json parseAnswer(std::string_view text) {
  if (isNestedDeeply(text)) return nlohmann::json(nlohmann::json::value_t::discarded);
  return nlohmann::json::parse(text, nullptr, false);
}

}  // namespace viewloom::bridge
