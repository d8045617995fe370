// SPDX-License-Identifier: Apache-2.0
// Public keys that sign JWTs, from a JSON Web Key Set (RFC 7517).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "access/digest.h"
#include "base/status.h"

// OpenSSL's key; its headers stay in the sources.
struct evp_pkey_st;

namespace viewloom {

enum class JwtAlgorithm : uint8_t { kEdDsa, kRs256, kEs256 };

struct PublicKey {
  std::string id;  // "kid"; empty = it has none
  JwtAlgorithm algorithm = JwtAlgorithm::kEdDsa;
  std::shared_ptr<evp_pkey_st> key;
  Digest digest{};  // SHA-256 of its SubjectPublicKeyInfo
};

// Whether `signature`, as a JWT holds it, is the key's signature of `bytes`. Thread-safety: may be
// called from any thread.
bool isSignedBy(const PublicKey& key, std::string_view bytes, std::string_view signature);

// Keys of Ed25519 (EdDSA), RSA of 2048 to 8192 bits (RS256) and P-256 (ES256). Others are left out.
// INVALID_ARGUMENT names the key ("jwks.json: keys[2]") and what is accepted: for damaged and
// private keys, for more than 32 keys, and if no key can be used.
absl::StatusOr<std::vector<PublicKey>> parseKeySet(std::string_view text,
                                                   std::string_view file_name);

}  // namespace viewloom
