// SPDX-License-Identifier: Apache-2.0
#include "access/bearer.h"

#include "absl/strings/match.h"
#include "base/str_cat.h"

namespace viewloom {

std::string_view bearerToken(std::string_view authorization) {
  constexpr std::string_view kScheme = "Bearer ";
  // Schemes are written in any case (RFC 9110, 11.1).
  if (!absl::StartsWithIgnoreCase(asAbslPart(authorization), asAbslPart(kScheme))) return {};
  authorization.remove_prefix(kScheme.size());
  const size_t begin = authorization.find_first_not_of(' ');
  if (begin == std::string_view::npos) return {};
  return authorization.substr(begin, authorization.find_last_not_of(' ') + 1 - begin);
}

}  // namespace viewloom
