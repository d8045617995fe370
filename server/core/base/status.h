// SPDX-License-Identifier: Apache-2.0
// Errors of foreign input: an absl::Status that names the field at fault.
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

// A refusal: `field` is the path in the request ("header.sources[0].layers[1].planes[0].size"),
// the message reads "<field>: <what came and what is accepted>".
absl::Status fieldError(absl::StatusCode code, std::string_view field, std::string_view problem);

// INVALID_ARGUMENT, the commonest.
absl::Status invalidField(std::string_view field, std::string_view problem);

// The field a fieldError named; empty for other statuses.
std::string fieldOf(const absl::Status& status);

// The same error seen from further up: "prefix.field" (or "prefix" when it named none).
absl::Status withFieldPrefix(const absl::Status& status, std::string_view prefix);

}  // namespace viewloom
