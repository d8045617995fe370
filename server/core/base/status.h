// SPDX-License-Identifier: Apache-2.0
// Errors of foreign input: an absl::Status that names the wrong field.
#pragma once

#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

#define VIEWLOOM_RETURN_IF_ERROR(expression)                                \
  do {                                                                      \
    if (absl::Status status_ = (expression); !status_.ok()) return status_; \
  } while (false)

namespace viewloom {

// Makes an error. `field` is the path in the request
// ("header.sources[0].layers[1].planes[0].size"). The message is "<field>: <problem>". The problem
// says in words what was given and what is accepted.
absl::Status fieldError(absl::StatusCode code, std::string_view field, std::string_view problem);

// Makes an INVALID_ARGUMENT error.
absl::Status invalidField(std::string_view field, std::string_view problem);

// Field of a fieldError; empty for other statuses.
std::string fieldOf(const absl::Status& status);

// The same error with the field "prefix.field", or "prefix" if it named none.
absl::Status withFieldPrefix(const absl::Status& status, std::string_view prefix);

}  // namespace viewloom
