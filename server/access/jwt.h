// SPDX-License-Identifier: Apache-2.0
// Signed JSON Web Tokens (RFC 7519) of an operator's own sign-in service.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "access/identity.h"
#include "access/key_set.h"

namespace viewloom {

// Claims that every JWT must have. Both are set.
struct JwtRules {
  std::string audience;  // "aud" is it, or lists it
  std::string issuer;    // "iss"
};

// Clocks of the two machines may differ by this.
inline constexpr int64_t kJwtClockSkew_s = 30;

// Whether a text has the form of a JWT: three parts, separated by dots.
bool isJwtForm(std::string_view text);

// The identity that a JWT proves: `sub` is its id, `roles`, `streams` and `limits` are its rights
// (rights_json.h), `exp` is its end. UNAUTHENTICATED says what is wrong: the form, the algorithm
// (EdDSA, RS256 and ES256 are accepted), the key, the signature, `exp`, `nbf`, `iss`, `aud`, or the
// rights. It never quotes the token.
absl::StatusOr<IdentityPtr> verifyJwt(std::string_view token, const std::vector<PublicKey>& keys,
                                      const JwtRules& rules, int64_t now_s);

}  // namespace viewloom
