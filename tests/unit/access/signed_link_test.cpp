// SPDX-License-Identifier: Apache-2.0
#include "access/signed_link.h"

#include <gtest/gtest.h>

namespace viewloom::signed_link_test {

Identity identityOf(const std::string& id, const std::string& token = "token") {
  return {.id = id,
          .proof = Proof::kToken,
          .rights = allRights(),
          .digest = sha256(token),
          .expires_s = {}};
}

const LinkTarget kTarget{.stream = "demo", .display = "quilt 8 6"};
constexpr int64_t kEnd_s = 1'800'000'000;

TEST(SignedLink, isGoodForItsOwnTargetAndIdentityAlone) {
  const LinkSigner signer;
  const Identity anna = identityOf("anna");
  const auto claim = parseLink(signer.sign(anna, kTarget, kEnd_s));
  ASSERT_TRUE(claim.ok()) << claim.status();
  EXPECT_EQ(claim->id, "anna");
  EXPECT_EQ(claim->expires_s, kEnd_s);
  EXPECT_TRUE(signer.isSigned(*claim, anna, kTarget));
  EXPECT_FALSE(signer.isSigned(*claim, anna, {.stream = "other", .display = kTarget.display}));
  EXPECT_FALSE(signer.isSigned(*claim, anna, {.stream = "demo", .display = "quilt 8 7"}));
  EXPECT_FALSE(signer.isSigned(*claim, identityOf("bert"), kTarget));
  EXPECT_FALSE(signer.isSigned(*claim, identityOf("anna", "new token"), kTarget));
  EXPECT_FALSE(LinkSigner().isSigned(*claim, anna, kTarget));
  LinkClaim longer = *claim;
  ++longer.expires_s;
  EXPECT_FALSE(signer.isSigned(longer, anna, kTarget));
  LinkClaim other_kind = *claim;
  other_kind.proof = Proof::kJwt;
  EXPECT_FALSE(signer.isSigned(other_kind, anna, kTarget));
}

TEST(SignedLink, tellsPartsOfItsTargetApart) {
  const LinkSigner signer;
  const Identity anna = identityOf("anna");
  const auto claim = parseLink(signer.sign(anna, {.stream = "a", .display = "b\nc"}, kEnd_s));
  EXPECT_FALSE(signer.isSigned(*claim, anna, {.stream = "a\nb", .display = "c"}) &&
               signer.isSigned(*claim, anna, {.stream = "a", .display = "b"}));
}

TEST(SignedLink, isReadInItsOwnFormAlone) {
  const std::string link = LinkSigner().sign(identityOf("anna"), kTarget, kEnd_s);
  for (const std::string& text :
       {std::string(), std::string("..."), link + ".", "x" + link, link + "A", link + "=",
        link.substr(1) + "?", "18000000000000000000000" + link, std::string(600, '.')}) {
    EXPECT_EQ(parseLink(text).status().code(), absl::StatusCode::kInvalidArgument) << text;
  }
}

}  // namespace viewloom::signed_link_test
