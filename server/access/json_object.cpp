// SPDX-License-Identifier: Apache-2.0
#include "access/json_object.h"

#include <set>
#include <vector>

namespace viewloom {

using nlohmann::json;

absl::StatusOr<json> parseJsonObject(std::string_view text) {
  std::vector<std::set<std::string>> names;  // of the objects that are open
  bool has_twins = false;
  const auto note = [&](int, json::parse_event_t event, json& parsed) {
    if (event == json::parse_event_t::object_start) names.emplace_back();
    if (event == json::parse_event_t::object_end) names.pop_back();
    if (event == json::parse_event_t::key) {
      has_twins |= !names.back().insert(parsed.get<std::string>()).second;
    }
    return true;
  };
  json object = json::parse(text, note, false);
  if (!object.is_object()) {
    return absl::InvalidArgumentError("is no JSON object; accepted is {\"name\": ...}");
  }
  if (has_twins) return absl::InvalidArgumentError("has a field twice; accepted is once");
  return object;
}

absl::StatusOr<std::string> textField(const json& object, const char* field) {
  const auto found = object.find(field);
  if (found == object.end()) return std::string();
  if (!found->is_string()) return invalidField(field, "is no text; accepted is a text in \"...\"");
  return found->get<std::string>();
}

}  // namespace viewloom
