// SPDX-License-Identifier: Apache-2.0
#include "unit/access/jwt_maker.h"

#include <openssl/bn.h>
#include <openssl/core_names.h>
#include <openssl/ec.h>
#include <openssl/evp.h>
#include <openssl/rsa.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "access/digest.h"

namespace viewloom {
namespace {

constexpr int kHalfBytes = 32;

std::string numberBytes(const BIGNUM* number, int size) {
  std::vector<unsigned char> bytes(static_cast<size_t>(size));
  BN_bn2binpad(number, bytes.data(), size);
  return {bytes.begin(), bytes.end()};
}

std::string parameter(EVP_PKEY* key, const char* name, int size = 0) {
  BIGNUM* number = nullptr;
  if (EVP_PKEY_get_bn_param(key, name, &number) != 1) throw std::runtime_error(name);
  const std::string bytes = numberBytes(number, size != 0 ? size : BN_num_bytes(number));
  BN_free(number);
  return base64Url(bytes);
}

std::string rawEcdsa(const std::string& der) {
  const auto* data = reinterpret_cast<const unsigned char*>(der.data());
  ECDSA_SIG* pair = d2i_ECDSA_SIG(nullptr, &data, static_cast<long>(der.size()));
  const std::string raw = numberBytes(ECDSA_SIG_get0_r(pair), kHalfBytes) +
                          numberBytes(ECDSA_SIG_get0_s(pair), kHalfBytes);
  ECDSA_SIG_free(pair);
  return raw;
}

}  // namespace

SigningKey::SigningKey(std::string algorithm, EVP_PKEY* key)
    : algorithm_(std::move(algorithm)), key_(key, EVP_PKEY_free) {}

SigningKey SigningKey::ed25519() {
  return {"EdDSA", EVP_PKEY_Q_keygen(nullptr, nullptr, "ED25519")};
}

SigningKey SigningKey::rsa(unsigned bits) {
  return {"RS256", EVP_PKEY_Q_keygen(nullptr, nullptr, "RSA", size_t{bits})};
}

SigningKey SigningKey::p256() {
  return {"ES256", EVP_PKEY_Q_keygen(nullptr, nullptr, "EC", "P-256")};
}

nlohmann::json SigningKey::jwk(const std::string& id) const {
  nlohmann::json jwk = {{"alg", algorithm_}, {"use", "sig"}};
  if (!id.empty()) jwk["kid"] = id;
  if (algorithm_ == "EdDSA") {
    std::string bytes(kHalfBytes, '\0');
    size_t size = bytes.size();
    EVP_PKEY_get_raw_public_key(key_.get(), reinterpret_cast<unsigned char*>(bytes.data()), &size);
    jwk.update({{"kty", "OKP"}, {"crv", "Ed25519"}, {"x", base64Url(bytes)}});
  } else if (algorithm_ == "RS256") {
    jwk.update({{"kty", "RSA"},
                {"n", parameter(key_.get(), OSSL_PKEY_PARAM_RSA_N)},
                {"e", parameter(key_.get(), OSSL_PKEY_PARAM_RSA_E)}});
  } else {
    jwk.update({{"kty", "EC"},
                {"crv", "P-256"},
                {"x", parameter(key_.get(), OSSL_PKEY_PARAM_EC_PUB_X, kHalfBytes)},
                {"y", parameter(key_.get(), OSSL_PKEY_PARAM_EC_PUB_Y, kHalfBytes)}});
  }
  return jwk;
}

std::string SigningKey::sign(std::string_view bytes) const {
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(),
                                                                        &EVP_MD_CTX_free);
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  std::string signature(1024, '\0');
  size_t size = signature.size();
  EVP_DigestSignInit(context.get(), nullptr, algorithm_ == "EdDSA" ? nullptr : EVP_sha256(),
                     nullptr, key_.get());
  EVP_DigestSign(context.get(), reinterpret_cast<unsigned char*>(signature.data()), &size, data,
                 bytes.size());
  signature.resize(size);
  return algorithm_ == "ES256" ? rawEcdsa(signature) : signature;
}

std::string SigningKey::jwt(const nlohmann::json& claims, const nlohmann::json& header) const {
  nlohmann::json whole = {{"alg", algorithm_}, {"typ", "JWT"}};
  if (!header.is_null()) whole.update(header);
  const std::string bytes = base64Url(whole.dump()) + "." + base64Url(claims.dump());
  return bytes + "." + base64Url(sign(bytes));
}

std::string keySetText(const nlohmann::json& jwks) {
  return nlohmann::json{{"keys", jwks}}.dump();
}

std::string unsignedJwt(const nlohmann::json& header, const nlohmann::json& claims) {
  return base64Url(header.dump()) + "." + base64Url(claims.dump()) + ".";
}

}  // namespace viewloom
