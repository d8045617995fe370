// SPDX-License-Identifier: Apache-2.0
#include "access/jwt.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/access/jwt_maker.h"

namespace viewloom::jwt_test {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr int64_t kNow_s = 1'800'000'000;
const JwtRules kRules{.audience = "viewloom", .issuer = "https://sign.in"};

json goodClaims() {
  return {{"sub", "anna"},
          {"iss", kRules.issuer},
          {"aud", kRules.audience},
          {"exp", kNow_s + 60},
          {"roles", {"watch"}},
          {"streams", {"room.*"}},
          {"limits", {{"displays", 2}}}};
}

json changed(const char* name, const json& value) {
  json claims = goodClaims();
  if (value.is_null()) {
    claims.erase(name);
  } else {
    claims[name] = value;
  }
  return claims;
}

class Jwt : public testing::Test {
 protected:
  absl::StatusOr<IdentityPtr> verify(const std::string& token) const {
    return verifyJwt(token, keys_, kRules, kNow_s);
  }
  // The message of a refusal.
  std::string refusal(const std::string& token) const {
    const auto identity = verify(token);
    EXPECT_EQ(identity.status().code(), absl::StatusCode::kUnauthenticated) << token;
    const std::string message(identity.status().message());
    EXPECT_THAT(message, Not(HasSubstr(token.substr(0, 20))));
    return message;
  }
  std::string refusal(const char* name, const json& value) const {
    return refusal(ed_.jwt(changed(name, value)));
  }

  const SigningKey ed_ = SigningKey::ed25519();
  const SigningKey rsa_ = SigningKey::rsa();
  const SigningKey ec_ = SigningKey::p256();
  const std::vector<PublicKey> keys_ =
      parseKeySet(keySetText({ed_.jwk("ed"), rsa_.jwk("rsa"), ec_.jwk("ec")}), "f").value();
};

TEST_F(Jwt, provesAnIdentityWithEachAlgorithm) {
  for (const SigningKey* key : {&ed_, &rsa_, &ec_}) {
    const auto identity = verify(key->jwt(goodClaims()));
    ASSERT_TRUE(identity.ok()) << identity.status();
    EXPECT_EQ((*identity)->id, "anna");
    EXPECT_EQ((*identity)->proof, Proof::kJwt);
    EXPECT_TRUE((*identity)->rights.has(Role::kWatch));
    EXPECT_FALSE((*identity)->rights.has(Role::kPublish));
    EXPECT_TRUE((*identity)->rights.streams.matches("room.1"));
    EXPECT_EQ((*identity)->rights.quota.displays, 2U);
    EXPECT_EQ((*identity)->expires_s, kNow_s + 60);
  }
  EXPECT_TRUE(verify(ed_.jwt(goodClaims(), {{"kid", "ed"}})).ok());
  EXPECT_TRUE(verify(ed_.jwt(changed("aud", {"other", "viewloom"}))).ok());
  EXPECT_TRUE(verify(ed_.jwt(changed("exp", kNow_s + 0.5 + 1))).ok());
}

TEST_F(Jwt, needsASignatureOfItsOwnKey) {
  const char* const other_algorithm = "another algorithm; accepted are EdDSA, RS256 and ES256";
  for (const char* name : {"none", "None", "", "HS256", "RS384", "PS256", "ES384", "eddsa"}) {
    EXPECT_THAT(refusal(unsignedJwt({{"alg", name}}, goodClaims())), HasSubstr(other_algorithm));
    EXPECT_THAT(refusal(ed_.jwt(goodClaims(), {{"alg", name}})), HasSubstr(other_algorithm));
  }
  EXPECT_THAT(refusal(unsignedJwt(json::object(), goodClaims())), HasSubstr(other_algorithm));
  EXPECT_THAT(refusal(unsignedJwt({{"alg", "EdDSA"}}, goodClaims())), HasSubstr("does not fit"));
  EXPECT_THAT(refusal(SigningKey::ed25519().jwt(goodClaims())), HasSubstr("does not fit"));
  EXPECT_THAT(refusal(SigningKey::rsa().jwt(goodClaims())), HasSubstr("does not fit"));
  EXPECT_THAT(refusal(SigningKey::p256().jwt(goodClaims())), HasSubstr("does not fit"));
  // The algorithm is that of the key, whatever the header says.
  EXPECT_THAT(refusal(ed_.jwt(goodClaims(), {{"kid", "rsa"}})), HasSubstr("unknown key"));
  EXPECT_THAT(refusal(rsa_.jwt(goodClaims(), {{"alg", "ES256"}, {"kid", "rsa"}})),
              HasSubstr("unknown key"));
  EXPECT_THAT(refusal(rsa_.jwt(goodClaims(), {{"alg", "ES256"}})), HasSubstr("does not fit"));
  EXPECT_THAT(refusal(ed_.jwt(goodClaims(), {{"kid", "gone"}})), HasSubstr("unknown key"));
  EXPECT_THAT(refusal(ed_.jwt(goodClaims(), {{"kid", 1}})), HasSubstr("kid that is no text"));
  EXPECT_THAT(refusal(ed_.jwt(goodClaims(), {{"crit", {"exp"}}})), HasSubstr("extensions"));
  // Keys that a header brings along are ignored.
  const SigningKey own = SigningKey::ed25519();
  EXPECT_THAT(refusal(own.jwt(goodClaims(), {{"jwk", own.jwk()}})), HasSubstr("does not fit"));
}

TEST_F(Jwt, isRefusedWithAnyByteChanged) {
  const std::string token = ed_.jwt(goodClaims());
  for (size_t i = 0; i < token.size(); i += 7) {
    std::string forged = token;
    forged[i] = forged[i] == 'A' ? 'B' : 'A';
    EXPECT_FALSE(verify(forged).ok()) << i;
  }
}

TEST_F(Jwt, isRefusedOutsideItsTime) {
  EXPECT_THAT(refusal("exp", kNow_s), HasSubstr("has expired"));
  EXPECT_THAT(refusal("exp", nullptr), HasSubstr("never expires"));
  EXPECT_THAT(refusal("exp", "tomorrow"), HasSubstr("no time in exp"));
  EXPECT_THAT(refusal("exp", 1e300), HasSubstr("no time in exp"));
  EXPECT_THAT(refusal("exp", -1), HasSubstr("no time in exp"));
  EXPECT_THAT(refusal("nbf", kNow_s + 31), HasSubstr("not valid yet"));
  EXPECT_TRUE(verify(ed_.jwt(changed("nbf", kNow_s + 30))).ok());
}

TEST_F(Jwt, isRefusedFromAndForOthers) {
  for (const json& value : {json(nullptr), json("https://other"), json({kRules.issuer}), json(1)}) {
    EXPECT_THAT(refusal("iss", value), HasSubstr("another issuer"));
  }
  for (const json& value : {json(nullptr), json("other"), json({"other"}), json(1), json("")}) {
    EXPECT_THAT(refusal("aud", value), HasSubstr("another audience"));
  }
}

TEST_F(Jwt, isRefusedWithoutASubjectOrRights) {
  for (const json& value : {json(nullptr), json(""), json(1), json(std::string(129, 'a'))}) {
    EXPECT_THAT(refusal("sub", value), HasSubstr("has no subject"));
  }
  EXPECT_THAT(refusal("roles", nullptr), HasSubstr("grants nothing: roles: is missing"));
  EXPECT_THAT(refusal("streams", nullptr), HasSubstr("grants nothing: streams: is missing"));
  EXPECT_THAT(refusal("roles", {"admin"}), HasSubstr("grants nothing: roles: got \"admin\""));
}

TEST_F(Jwt, isRefusedInAnotherForm) {
  const std::string token = ed_.jwt(goodClaims());
  for (const std::string& text :
       {std::string(".."), std::string("a.b.c"), token + "=", "e30.e30." + base64Url("x"),
        token + "." + token, std::string(), " " + token, token + "\n"}) {
    EXPECT_FALSE(verify(text).ok()) << text;
  }
  EXPECT_THAT(refusal(ed_.jwt(changed("more", std::string(9000, 'x')))), HasSubstr("up to 8192"));
  const std::string twice = R"({"alg":"none","alg":"EdDSA"})";
  EXPECT_THAT(refusal(base64Url(twice) + ".e30.AAAA"), HasSubstr("a field twice"));
}

}  // namespace viewloom::jwt_test
