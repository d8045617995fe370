// SPDX-License-Identifier: Apache-2.0
// The target of a request: a path and its parameters, decoded.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "base/status.h"

namespace viewloom {

using QueryParameters = std::map<std::string, std::string>;

struct Url {
  std::string path;  // begins with '/'
  QueryParameters parameters;
};

// Refuses broken escapes, control characters and parameters given twice.
absl::StatusOr<Url> parseUrl(std::string_view target);

// With everything escaped that is not unreserved (RFC 3986).
std::string percentEncoded(std::string_view plain);

// "a=1&b=2" with everything escaped that is not unreserved.
std::string queryString(const QueryParameters& parameters);

}  // namespace viewloom
