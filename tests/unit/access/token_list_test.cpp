// SPDX-License-Identifier: Apache-2.0
#include "access/token_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::token_list_test {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kRest =
    R"("sha256":"ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad",)"
    R"("roles":["watch"],"streams":["*"])";

std::string lineOf(const std::string& id, const std::string& more = "") {
  return "{\"id\":\"" + id + "\"," + kRest + more + "}";
}

TokenEntry entryFor(const std::string& token) {
  return {.identity = std::make_shared<Identity>(Identity{.id = "camera-1",
                                                          .proof = Proof::kToken,
                                                          .rights = allRights(),
                                                          .digest = sha256(token),
                                                          .expires_s = 1801396800}),
          .note = "lab, \"left\" wall"};
}

TEST(TokenList, makesTokensOf256Bits) {
  const std::string token = makeToken();
  EXPECT_TRUE(isTokenForm(token));
  EXPECT_EQ(token.size(), 52U);
  EXPECT_NE(token, makeToken());
}

TEST(TokenList, findsATokenByItsDigest) {
  const std::string token = makeToken();
  const std::string line = tokenLine(entryFor(token));
  EXPECT_THAT(line, Not(HasSubstr(token)));
  const auto list = TokenList::parse("# ours\n\n" + line + "\r\n" + lineOf("b"), "tokens");
  ASSERT_TRUE(list.ok()) << list.status();
  ASSERT_EQ(list->entries().size(), 2U);
  const IdentityPtr found = list->find(token);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->id, "camera-1");
  EXPECT_EQ(found->rights, allRights());
  EXPECT_EQ(found->expires_s, 1801396800);
  EXPECT_EQ(list->entries()[0].note, "lab, \"left\" wall");
  EXPECT_EQ(list->find(makeToken()), nullptr);
  EXPECT_EQ(list->find("abc")->id, "b");
  EXPECT_NE(list->named("b"), nullptr);
  EXPECT_EQ(list->named("c"), nullptr);
}

TEST(TokenList, namesTheLineThatIsWrong) {
  const std::pair<std::string, const char*> cases[] = {
      {"viewloom_secret", "tokens:2: is no JSON object"},
      {"{\"id\": \"secret\"", "tokens:2: is no JSON object"},
      {"[]", "tokens:2: is no JSON object"},
      {"{}", "tokens:2: id: is no name"},
      {lineOf("a b"), "tokens:2: id: is no name"},
      {lineOf("first"), "tokens:2: the id \"first\" is there twice"},
      {lineOf("a", ",\"id\":\"b\""), "tokens:2: has a field twice"},
      {lineOf("a", ",\"expire\":\"2027-01-31\""), "did you mean \"expires\"?"},
      {lineOf("a", ",\"expires\":\"soon\""), "tokens:2: expires: is no time"},
      {lineOf("a", ",\"expires\":1}"), "tokens:2: is no JSON object"},
      {lineOf("a", ",\"note\":1"), "tokens:2: note: is no text"},
      {lineOf("a", ",\"note\":\"" + std::string(9000, 'x') + "\""), "accepted are up to 8192"},
      {R"({"id":"a","sha256":"secret","roles":["watch"],"streams":["*"]})", "sha256: is not 64"},
  };
  for (const auto& [line, problem] : cases) {
    const auto list = TokenList::parse(lineOf("first") + "\n" + line + "\n", "tokens");
    ASSERT_EQ(list.status().code(), absl::StatusCode::kInvalidArgument) << line;
    EXPECT_THAT(std::string(list.status().message()), HasSubstr(problem));
    EXPECT_THAT(std::string(list.status().message()), Not(HasSubstr("secret")));
  }
}

}  // namespace viewloom::token_list_test
