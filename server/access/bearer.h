// SPDX-License-Identifier: Apache-2.0
// The token of an Authorization header (RFC 6750).
#pragma once

#include <string_view>

namespace viewloom {

// The token behind "Bearer "; empty for other schemes and without a header.
std::string_view bearerToken(std::string_view authorization);

}  // namespace viewloom
