// SPDX-License-Identifier: Apache-2.0
// A client that has proven its name, by an access token, a JWT or a signed link.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "access/digest.h"
#include "access/rights.h"

namespace viewloom {

// How an identity proves itself.
enum class Proof : uint8_t {
  kNothing,  // the server has neither a token file nor keys
  kToken,    // of the token file
  kJwt       // signed by a key of the JWKS file
};

// An identity never changes. It holds no secret: a digest leads back to no token.
struct Identity {
  std::string id;  // the token's id, or the subject of the JWT
  Proof proof = Proof::kNothing;
  Rights rights;
  Digest digest{};                   // of the token, or of the public key that signed the JWT
  std::optional<int64_t> expires_s;  // seconds since 1970; empty = never
};

using IdentityPtr = std::shared_ptr<const Identity>;

}  // namespace viewloom
