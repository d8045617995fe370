// SPDX-License-Identifier: Apache-2.0
// Explains to users why a proxy or a connection ended a call, and what to do.
#pragma once

#include <string>

#include "base/status.h"

namespace viewloom {

// Cause and remedy: "a proxy refused the amount of data (...); ...". Empty for statuses that the
// server itself gave, and for a server that cannot be reached.
std::string explainBrokenCall(const absl::Status& status);

// Reason why there is no connection to a server, or why it broke: "connection refused". It is
// gRPC's own message if nothing better is known.
std::string connectionProblem(const absl::Status& status);

}  // namespace viewloom
