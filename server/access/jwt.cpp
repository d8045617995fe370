// SPDX-License-Identifier: Apache-2.0
#include "access/jwt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "access/json_object.h"
#include "access/rights_json.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

using nlohmann::json;

constexpr size_t kJwtBytesMax = 8192;
constexpr size_t kSubjectBytesMax = 128;
constexpr double kTimeMax_s = 1e11;

struct AlgorithmName {
  std::string_view name;
  JwtAlgorithm algorithm;
};
constexpr std::array kAlgorithmNames = {AlgorithmName{"EdDSA", JwtAlgorithm::kEdDsa},
                                        AlgorithmName{"RS256", JwtAlgorithm::kRs256},
                                        AlgorithmName{"ES256", JwtAlgorithm::kEs256}};

struct JwtParts {
  std::string_view signed_bytes;  // header and claims, with the dot between them
  json header;
  json claims;
  std::string signature;
};

absl::Status refuseJwt(std::string_view problem) {
  return absl::UnauthenticatedError(strCat("the JWT ", problem));
}

absl::StatusOr<json> decodedObject(std::string_view part, std::string_view name) {
  const std::optional<std::string> bytes = bytesFromBase64Url(part);
  if (!bytes) return refuseJwt(strCat("has a ", name, " that is no base64url"));
  absl::StatusOr<json> object = parseJsonObject(*bytes);
  if (object.ok()) return object;
  return refuseJwt(strCat("has a ", name, " that ", std::string(object.status().message())));
}

absl::StatusOr<JwtParts> takeJwtApart(std::string_view token) {
  if (token.size() > kJwtBytesMax) {
    return refuseJwt(strCat("has ", token.size(), " bytes; accepted are up to ", kJwtBytesMax));
  }
  const size_t first = token.find('.');
  const size_t second = token.find('.', first + 1);
  JwtParts parts;
  parts.signed_bytes = token.substr(0, second);
  absl::StatusOr<json> header = decodedObject(token.substr(0, first), "header");
  VIEWLOOM_RETURN_IF_ERROR(header.status());
  absl::StatusOr<json> claims = decodedObject(token.substr(first + 1, second - first - 1), "body");
  VIEWLOOM_RETURN_IF_ERROR(claims.status());
  const std::optional<std::string> signature = bytesFromBase64Url(token.substr(second + 1));
  if (!signature) return refuseJwt("has a signature that is no base64url");
  parts.header = *std::move(header);
  parts.claims = *std::move(claims);
  parts.signature = *signature;
  return parts;
}

absl::StatusOr<JwtAlgorithm> algorithmOf(const json& header) {
  const absl::StatusOr<std::string> name = textField(header, "alg");
  const auto* const found = name.ok()
                                ? std::ranges::find(kAlgorithmNames, *name, &AlgorithmName::name)
                                : kAlgorithmNames.end();
  if (found == kAlgorithmNames.end()) {
    return refuseJwt("has another algorithm; accepted are EdDSA, RS256 and ES256");
  }
  // Extensions that must be understood (RFC 7515, 4.1.11).
  if (header.contains("crit")) return refuseJwt("asks for extensions; accepted is none");
  return found->algorithm;
}

// The key that signed it. A key only verifies its own algorithm.
absl::StatusOr<const PublicKey*> signerOf(const JwtParts& parts,
                                          const std::vector<PublicKey>& keys) {
  const absl::StatusOr<JwtAlgorithm> algorithm = algorithmOf(parts.header);
  VIEWLOOM_RETURN_IF_ERROR(algorithm.status());
  const absl::StatusOr<std::string> id = textField(parts.header, "kid");
  if (!id.ok()) return refuseJwt("has a kid that is no text");
  bool is_known = false;
  for (const PublicKey& key : keys) {
    if (key.algorithm != *algorithm || (!id->empty() && key.id != *id)) continue;
    is_known = true;
    if (isSignedBy(key, parts.signed_bytes, parts.signature)) return &key;
  }
  return refuseJwt(is_known ? "has a signature that does not fit"
                            : "is signed by an unknown key, or with another algorithm than its "
                              "key's; access.jwks_file lists the keys");
}

// A time in seconds; empty if the claim is missing.
absl::StatusOr<std::optional<int64_t>> timeClaim(const json& claims, const char* name) {
  const auto found = claims.find(name);
  if (found == claims.end()) return std::nullopt;
  const double seconds = found->is_number() ? found->get<double>() : -1;
  if (!(seconds >= 0 && seconds <= kTimeMax_s)) {
    return refuseJwt(strCat("has no time in ", name, "; accepted are seconds since 1970"));
  }
  return static_cast<int64_t>(std::floor(seconds));
}

absl::StatusOr<int64_t> checkedExpiry(const json& claims, int64_t now_s) {
  const absl::StatusOr<std::optional<int64_t>> expires_s = timeClaim(claims, "exp");
  VIEWLOOM_RETURN_IF_ERROR(expires_s.status());
  if (!*expires_s) return refuseJwt("never expires; accepted is one with exp");
  if (now_s >= **expires_s) return refuseJwt("has expired; sign in again");
  const absl::StatusOr<std::optional<int64_t>> begins_s = timeClaim(claims, "nbf");
  VIEWLOOM_RETURN_IF_ERROR(begins_s.status());
  if (*begins_s && now_s + kJwtClockSkew_s < **begins_s) {
    return refuseJwt("is not valid yet; compare the clocks of both machines");
  }
  return **expires_s;
}

bool isOrLists(const json& claims, const char* name, const std::string& text) {
  const auto found = claims.find(name);
  if (found == claims.end()) return false;
  if (found->is_array()) return std::ranges::find(*found, json(text)) != found->end();
  return *found == json(text);
}

absl::Status checkOrigin(const json& claims, const JwtRules& rules) {
  const auto issuer = claims.find("iss");
  if (issuer == claims.end() || *issuer != json(rules.issuer)) {
    return refuseJwt("comes from another issuer than access.issuer");
  }
  if (!isOrLists(claims, "aud", rules.audience)) {
    return refuseJwt("is for another audience than access.audience");
  }
  return absl::OkStatus();
}

}  // namespace

bool isJwtForm(std::string_view text) {
  return std::ranges::count(text, '.') == 2;
}

absl::StatusOr<IdentityPtr> verifyJwt(std::string_view token, const std::vector<PublicKey>& keys,
                                      const JwtRules& rules, int64_t now_s) {
  if (!isJwtForm(token)) return refuseJwt("does not have three parts");
  const absl::StatusOr<JwtParts> parts = takeJwtApart(token);
  VIEWLOOM_RETURN_IF_ERROR(parts.status());
  const absl::StatusOr<const PublicKey*> signer = signerOf(*parts, keys);
  VIEWLOOM_RETURN_IF_ERROR(signer.status());
  const absl::StatusOr<int64_t> expires_s = checkedExpiry(parts->claims, now_s);
  VIEWLOOM_RETURN_IF_ERROR(expires_s.status());
  VIEWLOOM_RETURN_IF_ERROR(checkOrigin(parts->claims, rules));
  absl::StatusOr<std::string> subject = textField(parts->claims, "sub");
  if (!subject.ok() || subject->empty() || subject->size() > kSubjectBytesMax) {
    return refuseJwt(
        strCat("has no subject; accepted is a sub of 1 to ", kSubjectBytesMax, " bytes"));
  }
  absl::StatusOr<Rights> rights = rightsFromJson(parts->claims);
  if (!rights.ok()) {
    return refuseJwt(strCat("grants nothing: ", std::string(rights.status().message())));
  }
  return std::make_shared<Identity>(Identity{.id = *std::move(subject),
                                             .proof = Proof::kJwt,
                                             .rights = *std::move(rights),
                                             .digest = (*signer)->digest,
                                             .expires_s = *expires_s});
}

}  // namespace viewloom
