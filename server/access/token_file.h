// SPDX-License-Identifier: Apache-2.0
// Changes the token file on behalf of an operator.
#pragma once

#include <string>
#include <string_view>

#include "access/token_list.h"

namespace viewloom {

// The tokens of a file; none if there is no file yet.
absl::StatusOr<TokenList> readTokenFile(const std::string& path);

// Both replace the file in one step: a server reads the old one or the new one. Only the owner may
// read the new one. Other changes wait meanwhile. Comments and other lines stay.

// ALREADY_EXISTS if the id is taken.
absl::Status addToTokenFile(const std::string& path, const TokenEntry& entry);
// NOT_FOUND, with the ids that there are.
absl::Status removeFromTokenFile(const std::string& path, std::string_view id);

}  // namespace viewloom
