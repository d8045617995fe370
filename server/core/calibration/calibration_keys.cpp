// SPDX-License-Identifier: Apache-2.0
#include "calibration/calibration_keys.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/str_cat.h"

namespace viewloom {
namespace {

using nlohmann::json;

constexpr size_t kTextBytesMax = 100;
constexpr size_t kShownBytesMax = 40;

// Null where the key is absent.
const json* valueAt(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end()) return nullptr;
  if (!found->is_object()) return &*found;
  const auto inner = found->find("value");
  return inner == found->end() ? &*found : &*inner;
}

std::string accepted(const NumberKey& key) {
  return strCat("accepted is a ", key.is_whole ? "whole " : "", "number ", key.min, "..", key.max,
                ", plain or as {\"value\": x}");
}

}  // namespace

absl::Status refuseKey(std::string_view key, std::string_view problem) {
  return invalidField(
      key, strCat(problem, "; copy LKG_calibration/visual.json from the device once more"));
}

absl::StatusOr<double> readNumber(const json& object, const NumberKey& key) {
  const json* value = valueAt(object, key.name);
  if (value == nullptr) {
    if (key.fallback) return *key.fallback;
    return refuseKey(key.name, strCat("is missing; ", accepted(key)));
  }
  if (!value->is_number()) {
    return refuseKey(key.name, strCat("is ", describeJson(*value), "; ", accepted(key)));
  }
  const double number = value->get<double>();
  const bool is_whole = number == std::floor(number);
  if (number >= key.min && number <= key.max && (is_whole || !key.is_whole)) return number;
  return refuseKey(key.name, strCat("is ", describeJson(*value), "; ", accepted(key)));
}

absl::StatusOr<std::string> readText(const json& object, const char* key) {
  const json* value = valueAt(object, key);
  if (value == nullptr) return std::string();
  if (value->is_string() && value->get_ref<const std::string&>().size() <= kTextBytesMax) {
    return value->get<std::string>();
  }
  return refuseKey(key, strCat("is ", describeJson(*value), "; accepted is a text of up to ",
                               kTextBytesMax, " bytes"));
}

std::string describeJson(const json& value) {
  std::string text = value.dump(-1, ' ', true);  // in ASCII: it may be cut anywhere
  if (text.size() > kShownBytesMax) text = text.substr(0, kShownBytesMax) + "...";
  return text;
}

}  // namespace viewloom
