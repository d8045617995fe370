// SPDX-License-Identifier: Apache-2.0
// Access tokens and the file that lists them: one JSON object a line.
//
//   {"id": "camera-1", "sha256": "9f86...", "roles": ["publish"], "streams": ["room.*"],
//    "limits": {"streams": 2}, "expires": "2027-01-31T12:00:00Z", "note": "lab, left wall"}
//
// The file holds digests only. Empty lines, and lines that begin with '#', mean nothing.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "access/identity.h"

namespace viewloom {

struct TokenEntry {
  IdentityPtr identity;
  std::string note;
};

// A new token: "viewloom_" and 43 characters for 256 random bits.
std::string makeToken();
// Whether a text has the form of a token. JWTs have another.
bool isTokenForm(std::string_view text);

// [A-Za-z0-9._-]{1,64}
absl::Status validateTokenId(std::string_view id);

// The line of a token, without a line break.
std::string tokenLine(const TokenEntry& entry);

// A list never changes.
class TokenList {
 public:
  // INVALID_ARGUMENT names the place ("tokens.jsonl:3") and what is accepted. It never quotes a
  // line.
  static absl::StatusOr<TokenList> parse(std::string_view text, std::string_view file_name);

  const std::vector<TokenEntry>& entries() const { return entries_; }
  // Null for an unknown token. Takes the same time for every token.
  IdentityPtr find(std::string_view token) const;
  // Null for an unknown id.
  const TokenEntry* named(std::string_view id) const;

 private:
  std::vector<TokenEntry> entries_;                    // in the order of the file
  std::map<std::string, size_t, std::less<>> places_;  // of entries_, by id
};

}  // namespace viewloom
