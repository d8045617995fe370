// SPDX-License-Identifier: Apache-2.0
#include "access/key_set.h"

#include <openssl/bn.h>
#include <openssl/core_names.h>
#include <openssl/ec.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/param_build.h>
#include <openssl/x509.h>

#include <algorithm>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "access/json_object.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

using nlohmann::json;

constexpr size_t kKeyCountMax = 32;
constexpr size_t kKeyIdBytesMax = 256;
constexpr int kRsaBitsMin = 2048;
constexpr int kRsaBitsMax = 8192;
constexpr size_t kEd25519Bytes = 32;
constexpr size_t kP256CoordinateBytes = 32;

template <auto kFree>
struct FreeWith {
  template <typename Type>
  void operator()(Type* value) const {
    kFree(value);
  }
};
template <typename Type, auto kFree>
using Owned = std::unique_ptr<Type, FreeWith<kFree>>;
using Number = Owned<BIGNUM, BN_free>;
using KeyPtr = std::shared_ptr<EVP_PKEY>;

const unsigned char* octets(std::string_view bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

absl::Status damagedKey() {
  return absl::InvalidArgumentError("is damaged; export the public key anew");
}

// The bytes of a base64url field.
absl::StatusOr<std::string> octetField(const json& jwk, const char* field) {
  const absl::StatusOr<std::string> text = textField(jwk, field);
  VIEWLOOM_RETURN_IF_ERROR(text.status());
  const std::optional<std::string> bytes = bytesFromBase64Url(*text);
  if (bytes && !bytes->empty()) return *bytes;
  return invalidField(field, "is missing or no base64url; export the public key anew");
}

// Makes a key of one kind from its parameters. Null if they do not fit.
KeyPtr keyOf(const char* kind, OSSL_PARAM_BLD& parameters) {
  const Owned<OSSL_PARAM, OSSL_PARAM_free> list(OSSL_PARAM_BLD_to_param(&parameters));
  const Owned<EVP_PKEY_CTX, EVP_PKEY_CTX_free> context(
      EVP_PKEY_CTX_new_from_name(nullptr, kind, nullptr));
  EVP_PKEY* key = nullptr;
  const bool is_made = list != nullptr && context != nullptr &&
                       EVP_PKEY_fromdata_init(context.get()) == 1 &&
                       EVP_PKEY_fromdata(context.get(), &key, EVP_PKEY_PUBLIC_KEY, list.get()) == 1;
  KeyPtr owned(key, EVP_PKEY_free);
  return is_made ? owned : nullptr;
}

absl::StatusOr<KeyPtr> ed25519Key(const json& jwk) {
  const absl::StatusOr<std::string> x = octetField(jwk, "x");
  VIEWLOOM_RETURN_IF_ERROR(x.status());
  if (x->size() != kEd25519Bytes) return damagedKey();
  KeyPtr key(EVP_PKEY_new_raw_public_key(EVP_PKEY_ED25519, nullptr, octets(*x), x->size()),
             EVP_PKEY_free);
  if (key == nullptr) return damagedKey();
  return key;
}

absl::StatusOr<KeyPtr> rsaKey(const json& jwk) {
  const absl::StatusOr<std::string> n = octetField(jwk, "n");
  VIEWLOOM_RETURN_IF_ERROR(n.status());
  const absl::StatusOr<std::string> e = octetField(jwk, "e");
  VIEWLOOM_RETURN_IF_ERROR(e.status());
  const Number modulus(BN_bin2bn(octets(*n), static_cast<int>(n->size()), nullptr));
  const Number exponent(BN_bin2bn(octets(*e), static_cast<int>(e->size()), nullptr));
  const int bits = BN_num_bits(modulus.get());
  if (bits < kRsaBitsMin || bits > kRsaBitsMax) {
    return absl::InvalidArgumentError(strCat("is an RSA key of ", bits, " bits; accepted are ",
                                             kRsaBitsMin, " to ", kRsaBitsMax));
  }
  // Larger exponents only cost time at every check.
  const bool is_usual = BN_is_odd(modulus.get()) == 1 && BN_is_odd(exponent.get()) == 1 &&
                        BN_num_bits(exponent.get()) >= 2 && BN_num_bits(exponent.get()) <= 32;
  if (!is_usual) return damagedKey();
  const Owned<OSSL_PARAM_BLD, OSSL_PARAM_BLD_free> parameters(OSSL_PARAM_BLD_new());
  OSSL_PARAM_BLD_push_BN(parameters.get(), OSSL_PKEY_PARAM_RSA_N, modulus.get());
  OSSL_PARAM_BLD_push_BN(parameters.get(), OSSL_PKEY_PARAM_RSA_E, exponent.get());
  KeyPtr key = keyOf("RSA", *parameters);
  if (key == nullptr) return damagedKey();
  return key;
}

absl::StatusOr<KeyPtr> p256Key(const json& jwk) {
  const absl::StatusOr<std::string> x = octetField(jwk, "x");
  VIEWLOOM_RETURN_IF_ERROR(x.status());
  const absl::StatusOr<std::string> y = octetField(jwk, "y");
  VIEWLOOM_RETURN_IF_ERROR(y.status());
  if (x->size() != kP256CoordinateBytes || y->size() != kP256CoordinateBytes) return damagedKey();
  const std::string point = strCat("\x04", *x, *y);  // uncompressed
  const Owned<OSSL_PARAM_BLD, OSSL_PARAM_BLD_free> parameters(OSSL_PARAM_BLD_new());
  OSSL_PARAM_BLD_push_utf8_string(parameters.get(), OSSL_PKEY_PARAM_GROUP_NAME, "prime256v1", 0);
  OSSL_PARAM_BLD_push_octet_string(parameters.get(), OSSL_PKEY_PARAM_PUB_KEY, point.data(),
                                   point.size());
  KeyPtr key = keyOf("EC", *parameters);
  if (key == nullptr) return damagedKey();
  // Points that are not on the curve would let others sign.
  const Owned<EVP_PKEY_CTX, EVP_PKEY_CTX_free> context(
      EVP_PKEY_CTX_new_from_pkey(nullptr, key.get(), nullptr));
  if (EVP_PKEY_public_check(context.get()) != 1) return damagedKey();
  return key;
}

// How a kind of key is written, and what it signs with.
struct KeyForm {
  std::string_view type;   // "kty"
  std::string_view curve;  // "crv"; "" = has none
  std::string_view usage;  // "alg"
  JwtAlgorithm algorithm;
  absl::StatusOr<KeyPtr> (*read)(const json& jwk);
};
constexpr KeyForm kKeyForms[] = {{"OKP", "Ed25519", "EdDSA", JwtAlgorithm::kEdDsa, ed25519Key},
                                 {"RSA", "", "RS256", JwtAlgorithm::kRs256, rsaKey},
                                 {"EC", "P-256", "ES256", JwtAlgorithm::kEs256, p256Key}};

bool holdsText(const json& jwk, const char* field, std::string_view text) {
  const auto found = jwk.find(field);
  return found != jwk.end() && found->is_string() && found->get_ref<const std::string&>() == text;
}

bool isAbsentOr(const json& jwk, const char* field, std::string_view text) {
  return !jwk.contains(field) || holdsText(jwk, field, text);
}

// Null for keys of other kinds and purposes.
const KeyForm* formOf(const json& jwk) {
  const auto* const found = std::ranges::find_if(kKeyForms, [&](const KeyForm& form) {
    return holdsText(jwk, "kty", form.type) && isAbsentOr(jwk, "alg", form.usage) &&
           isAbsentOr(jwk, "use", "sig") &&
           (form.curve.empty() || holdsText(jwk, "crv", form.curve));
  });
  return found == std::end(kKeyForms) ? nullptr : found;
}

Digest digestOf(EVP_PKEY* key) {
  unsigned char* bytes = nullptr;
  const int size = i2d_PUBKEY(key, &bytes);
  const Digest digest =
      sha256({reinterpret_cast<const char*>(bytes), static_cast<size_t>(std::max(size, 0))});
  OPENSSL_free(bytes);
  return digest;
}

absl::StatusOr<std::optional<PublicKey>> readKey(const json& jwk) {
  if (!jwk.is_object()) return absl::InvalidArgumentError("is no JSON object");
  if (jwk.contains("d")) {
    return absl::InvalidArgumentError(
        "is a private key; accepted are public keys. Take the private key out of this file");
  }
  const KeyForm* const form = formOf(jwk);
  if (form == nullptr) return std::nullopt;
  PublicKey key{.id = "", .algorithm = form->algorithm, .key = nullptr, .digest = {}};
  const absl::StatusOr<std::string> id = textField(jwk, "kid");
  VIEWLOOM_RETURN_IF_ERROR(id.status());
  if (id->size() > kKeyIdBytesMax) {
    return invalidField("kid",
                        strCat("is too long; accepted are up to ", kKeyIdBytesMax, " bytes"));
  }
  key.id = *id;
  absl::StatusOr<KeyPtr> made = form->read(jwk);
  ERR_clear_error();
  VIEWLOOM_RETURN_IF_ERROR(made.status());
  key.key = *std::move(made);
  key.digest = digestOf(key.key.get());
  return key;
}

// A JWT holds both numbers of an ECDSA signature as they are, OpenSSL reads them as DER.
std::optional<std::string> derSignature(std::string_view signature) {
  constexpr int kHalf = static_cast<int>(kP256CoordinateBytes);
  if (signature.size() != 2 * kP256CoordinateBytes) return std::nullopt;
  const Owned<ECDSA_SIG, ECDSA_SIG_free> pair(ECDSA_SIG_new());
  Number r(BN_bin2bn(octets(signature), kHalf, nullptr));
  Number s(BN_bin2bn(octets(signature) + kHalf, kHalf, nullptr));
  if (ECDSA_SIG_set0(pair.get(), r.get(), s.get()) != 1) return std::nullopt;
  static_cast<void>(r.release());  // now of the pair
  static_cast<void>(s.release());
  unsigned char* der = nullptr;
  const int size = i2d_ECDSA_SIG(pair.get(), &der);
  if (size <= 0) return std::nullopt;
  std::string bytes(reinterpret_cast<const char*>(der), static_cast<size_t>(size));
  OPENSSL_free(der);
  return bytes;
}

}  // namespace

bool isSignedBy(const PublicKey& key, std::string_view bytes, std::string_view signature) {
  std::string der;
  if (key.algorithm == JwtAlgorithm::kEs256) {
    std::optional<std::string> made = derSignature(signature);
    if (!made) return false;
    der = *std::move(made);
    signature = der;
  }
  const bool hashes_itself = key.algorithm == JwtAlgorithm::kEdDsa;
  const Owned<EVP_MD_CTX, EVP_MD_CTX_free> context(EVP_MD_CTX_new());
  const bool is_signed =
      EVP_DigestVerifyInit(context.get(), nullptr, hashes_itself ? nullptr : EVP_sha256(), nullptr,
                           key.key.get()) == 1 &&
      EVP_DigestVerify(context.get(), octets(signature), signature.size(), octets(bytes),
                       bytes.size()) == 1;
  ERR_clear_error();
  return is_signed;
}

absl::StatusOr<std::vector<PublicKey>> parseKeySet(std::string_view text,
                                                   std::string_view file_name) {
  const absl::StatusOr<json> set = parseJsonObject(text);
  const auto refuse = [&](std::string_view problem) {
    return absl::InvalidArgumentError(strCat(file_name, ": ", problem));
  };
  if (!set.ok()) return refuse(std::string(set.status().message()));
  const auto list = set->find("keys");
  if (list == set->end() || !list->is_array()) {
    return refuse("has no list \"keys\"; accepted is a JSON Web Key Set, {\"keys\": [...]}");
  }
  if (list->size() > kKeyCountMax) {
    return refuse(strCat("has ", list->size(), " keys; accepted are up to ", kKeyCountMax));
  }
  std::vector<PublicKey> keys;
  for (size_t i = 0; i < list->size(); ++i) {
    absl::StatusOr<std::optional<PublicKey>> key = readKey((*list)[i]);
    if (!key.ok()) {
      return refuse(strCat("keys[", i, "]: ", std::string(key.status().message())));
    }
    if (*key) keys.push_back(**std::move(key));
  }
  if (keys.empty()) {
    return refuse(
        "has no key that viewloom uses; accepted are Ed25519 (EdDSA), RSA (RS256) and "
        "P-256 (ES256)");
  }
  return keys;
}

}  // namespace viewloom
