// SPDX-License-Identifier: Apache-2.0
#include "inspect/number_text.h"

#include <array>
#include <charconv>

namespace viewloom::inspect {
namespace {

template <typename Number>
std::string shortest(Number number) {
  std::array<char, 64> text;
  const auto written = std::to_chars(text.data(), text.data() + text.size(), number);
  return {text.data(), written.ptr};
}

}  // namespace

std::string numberText(double number) {
  return shortest(number);
}

std::string numberText(float number) {
  return shortest(number);
}

}  // namespace viewloom::inspect
