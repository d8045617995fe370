// SPDX-License-Identifier: Apache-2.0
// Checks of the values of options. A refusal says what was given and what is accepted.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <type_traits>
#include <vector>

#include "base/printable.h"
#include "base/str_cat.h"

namespace viewloom::usage {

inline std::string joined(const std::vector<std::string>& words, const char* separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

// "got "ten"; accepted is a whole number".
inline std::string refusal(const std::string& given, const std::string& accepted) {
  return strCat("got \"", printable(given), "\"; accepted is ", accepted);
}

// Accepts the words alone, and suggests the nearest of them to another.
CLI::Validator oneOf(std::vector<std::string> words);

// Accepts all numbers of a type. The parser itself refuses an empty text.
template <typename Number>
CLI::Validator anyNumber() {
  const char* const accepted = std::is_floating_point_v<Number> ? "a number"
                               : std::is_signed_v<Number>       ? "a whole number"
                                                                : "a whole number, 0 or more";
  const auto refuse = [accepted](const std::string& given) {
    Number number{};
    const bool is_fine = given.empty() || CLI::detail::lexical_cast(given, number);
    return is_fine ? std::string() : refusal(given, accepted);
  };
  return {[refuse](std::string& given) { return refuse(given); }, ""};
}

// Accepts numbers from `min` to `max`, both included.
template <typename Number>
CLI::Validator inRange(Number min, Number max, const std::string& accepted) {
  const auto refuse = [min, max, accepted](const std::string& given) {
    Number number{};
    const bool is_number = CLI::detail::lexical_cast(given, number);
    if (is_number && !(number < min || number > max)) return std::string();
    return refusal(given, accepted);
  };
  return {[refuse](std::string& given) { return refuse(given); }, ""};
}

}  // namespace viewloom::usage
