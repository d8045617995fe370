// SPDX-License-Identifier: Apache-2.0
// Makes keys and signs JWTs with them, as a sign-in service does.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

struct evp_pkey_st;

namespace viewloom {

class SigningKey {
 public:
  static SigningKey ed25519();
  static SigningKey rsa(unsigned bits = 2048);
  static SigningKey p256();

  // "EdDSA", "RS256", "ES256".
  const std::string& algorithm() const { return algorithm_; }
  // The public key, with "kid" unless it is empty.
  nlohmann::json jwk(const std::string& id = "") const;
  std::string sign(std::string_view bytes) const;
  // A JWT whose header has this key's algorithm, and `header` above it.
  std::string jwt(const nlohmann::json& claims, const nlohmann::json& header = {}) const;

 private:
  SigningKey(std::string algorithm, evp_pkey_st* key);

  std::string algorithm_;
  std::shared_ptr<evp_pkey_st> key_;
};

// {"keys": [...]}
std::string keySetText(const nlohmann::json& jwks);
// A header and claims without a signature.
std::string unsignedJwt(const nlohmann::json& header, const nlohmann::json& claims);

}  // namespace viewloom
