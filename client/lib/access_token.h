// SPDX-License-Identifier: Apache-2.0
// Access tokens of servers that ask for them: where clients find theirs.
#pragma once

#include <string>
#include <string_view>

#include "base/status.h"

namespace viewloom {

// The token in the environment variable VIEWLOOM_TOKEN; "" if it is not set.
std::string tokenOfEnvironment();

// The token in a file that holds nothing else. INVALID_ARGUMENT names the file, and never quotes
// it.
absl::StatusOr<std::string> readAccessToken(const std::string& path);

// Whether a text can be sent as a token: 1 to 8192 visible ASCII characters.
bool isSendableToken(std::string_view text);

}  // namespace viewloom
