// SPDX-License-Identifier: Apache-2.0
#include "access/key_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/access/jwt_maker.h"

namespace viewloom::key_set_test {

using nlohmann::json;
using testing::HasSubstr;

std::string problemOf(const json& jwks) {
  return std::string(parseKeySet(keySetText(jwks), "jwks.json").status().message());
}

TEST(KeySet, readsKeysOfThreeKinds) {
  const SigningKey keys[] = {SigningKey::ed25519(), SigningKey::rsa(), SigningKey::p256()};
  json jwks = json::array();
  for (const SigningKey& key : keys) jwks.push_back(key.jwk(key.algorithm()));
  const auto set = parseKeySet(keySetText(jwks), "jwks.json");
  ASSERT_TRUE(set.ok()) << set.status();
  ASSERT_EQ(set->size(), 3U);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ((*set)[i].id, keys[i].algorithm());
    const std::string signature = keys[i].sign("text");
    for (size_t other = 0; other < 3; ++other) {
      EXPECT_EQ(isSignedBy((*set)[other], "text", signature), other == i);
    }
    EXPECT_FALSE(isSignedBy((*set)[i], "other text", signature));
    EXPECT_FALSE(isSignedBy((*set)[i], "text", ""));
    EXPECT_FALSE(isSignedBy((*set)[i], "text", signature + "x"));
  }
  EXPECT_NE((*set)[0].digest, (*set)[1].digest);
}

TEST(KeySet, leavesOutKeysOfOtherKindsAndPurposes) {
  json for_encryption = SigningKey::p256().jwk();
  for_encryption["use"] = "enc";
  json other_algorithm = SigningKey::rsa().jwk();
  other_algorithm["alg"] = "RS384";
  json other_curve = SigningKey::p256().jwk();
  other_curve["crv"] = "P-384";
  const json unknown = {
      for_encryption, other_algorithm, other_curve, {{"kty", "oct"}, {"k", "c2VjcmV0"}}};
  EXPECT_THAT(problemOf(unknown), HasSubstr("has no key that viewloom uses"));
  json with_one = unknown;
  with_one.push_back(SigningKey::ed25519().jwk());
  EXPECT_EQ(parseKeySet(keySetText(with_one), "jwks.json")->size(), 1U);
}

TEST(KeySet, namesTheKeyThatIsWrong) {
  const json good = SigningKey::ed25519().jwk();
  const auto with = [](json jwk, const char* field, const json& value) {
    jwk[field] = value;
    return jwk;
  };
  const json rsa = SigningKey::rsa().jwk();
  const json p256 = SigningKey::p256().jwk();
  const std::string zeros(43, 'A');
  const std::pair<json, const char*> cases[] = {
      {with(good, "d", "c2VjcmV0"), "keys[1]: is a private key"},
      {with(good, "x", "AAAA"), "keys[1]: is damaged"},
      {with(good, "x", "?"), "keys[1]: x: is missing or no base64url"},
      {with(good, "kid", 7), "keys[1]: kid: is no text"},
      {with(good, "kid", std::string(300, 'k')), "keys[1]: kid: is too long"},
      {with(p256, "y", zeros), "keys[1]: is damaged"},
      {with(p256, "x", "AAAA"), "keys[1]: is damaged"},
      {with(rsa, "e", "Ag"), "keys[1]: is damaged"},
      {with(rsa, "n", "AQAB"), "keys[1]: is an RSA key of 17 bits"},
      {SigningKey::rsa(1024).jwk(), "keys[1]: is an RSA key of 1024 bits; accepted are 2048"},
      {json("text"), "keys[1]: is no JSON object"},
  };
  for (const auto& [jwk, problem] : cases) {
    const std::string text = problemOf({good, jwk});
    EXPECT_THAT(text, HasSubstr(problem));
    EXPECT_THAT(text, testing::StartsWith("jwks.json: "));
    EXPECT_THAT(text, testing::Not(HasSubstr("c2VjcmV0")));
  }
}

TEST(KeySet, refusesOtherTexts) {
  for (const char* text : {"", "{", "[]", "{}", R"({"keys": 1})", R"({"keys": []})"}) {
    EXPECT_EQ(parseKeySet(text, "f").status().code(), absl::StatusCode::kInvalidArgument) << text;
  }
  EXPECT_THAT(problemOf(json(std::vector<json>(33, SigningKey::ed25519().jwk()))),
              HasSubstr("accepted are up to 32"));
}

}  // namespace viewloom::key_set_test
