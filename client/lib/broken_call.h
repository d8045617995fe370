// SPDX-License-Identifier: Apache-2.0
// Why a proxy or a connection ended a call, and what to do about it, in a user's words.
#pragma once

#include <string>

#include "base/status.h"

namespace viewloom {

// "a proxy refused the amount of data (...); ...". Empty for statuses that the server itself gave,
// and for a server that cannot be reached.
std::string explainBrokenCall(const absl::Status& status);

// Why no connection to a server comes about, or why it broke: "connection refused". gRPC's own
// message where that is all there is.
std::string connectionProblem(const absl::Status& status);

}  // namespace viewloom
