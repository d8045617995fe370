// SPDX-License-Identifier: Apache-2.0
// Parameters of a URL that say what to watch: their names, and the numbers in them.
#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <type_traits>

#include "base/status.h"
#include "base/str_cat.h"
#include "web/url.h"

namespace viewloom {

// A parameter, and the field of the API that the checks of displays and encodings name.
struct ParameterField {
  const char* parameter;
  const char* field;
};

// Leaves `value` alone when the parameter is not given. INVALID_ARGUMENT names the parameter.
template <typename Number>
absl::Status readNumber(const QueryParameters& parameters, const char* name, Number& value) {
  const auto found = parameters.find(name);
  if (found == parameters.end()) return absl::OkStatus();
  const std::string& text = found->second;
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  if (!whole || !std::isfinite(static_cast<double>(number))) {
    return invalidField(name, strCat("got \"", text, "\", accepted is a ",
                                     std::is_integral_v<Number> ? "whole number" : "number"));
  }
  value = number;
  return absl::OkStatus();
}

}  // namespace viewloom
