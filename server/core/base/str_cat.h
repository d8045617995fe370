// SPDX-License-Identifier: Apache-2.0
// absl::StrCat that also takes std::string_view: Debian's absl is built with a string_view of its
// own.
#pragma once

#include <string>
#include <string_view>

#include "absl/strings/str_cat.h"

namespace viewloom {

template <typename Part>
const Part& asAbslPart(const Part& part) {
  return part;
}
inline absl::string_view asAbslPart(std::string_view part) {
  return {part.data(), part.size()};
}

// Joins all parts to a text. Numbers have up to six significant digits.
template <typename... Parts>
std::string strCat(const Parts&... parts) {
  return absl::StrCat(asAbslPart(parts)...);
}

}  // namespace viewloom
