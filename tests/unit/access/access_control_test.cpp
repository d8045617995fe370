// SPDX-License-Identifier: Apache-2.0
#include "access/access_control.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "access/token_file.h"
#include "unit/access/jwt_maker.h"

namespace viewloom::access_control_test {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr int64_t kNow_s = 1'800'000'000;
constexpr int64_t kSecond_ns = 1'000'000'000;
constexpr auto kUnauthenticated = absl::StatusCode::kUnauthenticated;

class Access : public testing::Test {
 protected:
  Access() {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~Access() override { std::filesystem::remove_all(folder_); }

  std::string add(const std::string& id, std::optional<int64_t> expires_s = {},
                  Rights rights = allRights()) {
    std::string token = makeToken();
    const auto identity = std::make_shared<Identity>(Identity{.id = id,
                                                              .proof = Proof::kToken,
                                                              .rights = std::move(rights),
                                                              .digest = sha256(token),
                                                              .expires_s = expires_s});
    EXPECT_TRUE(addToTokenFile(tokens_, {.identity = identity, .note = ""}).ok());
    return token;
  }
  std::unique_ptr<AccessControl> open() {
    return std::make_unique<AccessControl>(
        AccessOptions{.token_file = std::filesystem::exists(tokens_) ? tokens_ : "",
                      .jwks_file = std::filesystem::exists(keys_) ? keys_ : "",
                      .audience = "viewloom",
                      .issuer = "issuer",
                      .audit_file = audit_,
                      .now_s = [this] { return now_s_; }},
        clock_);
  }
  void writeKeys(const json& jwks) const { std::ofstream(keys_) << keySetText(jwks); }
  std::string jwt(const SigningKey& key) const {
    return key.jwt({{"sub", "anna"},
                    {"iss", "issuer"},
                    {"aud", "viewloom"},
                    {"exp", now_s_ + 600},
                    {"roles", "watch"},
                    {"streams", "room.*"}});
  }
  void waitForLook() { clock_.advance(kSecond_ns); }
  std::string auditText() const {
    std::stringstream text;
    text << std::ifstream(audit_).rdbuf();
    return text.str();
  }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("viewloom_access_test_" + std::to_string(getpid()));
  const std::string tokens_ = folder_ / "tokens.jsonl";
  const std::string keys_ = folder_ / "jwks.json";
  const std::string audit_ = folder_ / "audit.jsonl";
  const LinkTarget target_{.stream = "room.1", .display = "quilt"};
  int64_t now_s_ = kNow_s;
  ManualClock clock_;
};

TEST_F(Access, isOpenToAllWithoutFiles) {
  AccessControl access(clock_);
  EXPECT_FALSE(access.isOn());
  const auto caller = access.admit(kPublishFrames, "peer", "");
  ASSERT_TRUE(caller.ok());
  EXPECT_TRUE(caller->mayUse("any").ok());
  EXPECT_TRUE(caller->recheck().ok());
}

TEST_F(Access, namesWhoseShareACallerTakes) {
  AccessControl open_access(clock_);
  const auto anybody = open_access.admit(kPublishFrames, "10.0.0.7", "");
  EXPECT_EQ(anybody->shareName("10.0.0.7"), "10.0.0.7");
  EXPECT_EQ(anybody->shareName("127.0.0.1"), "this machine");
  EXPECT_EQ(anybody->shareName("CN=camera-1"), "CN=camera-1");
  const std::string token = add("a");
  const auto access = open();
  EXPECT_EQ(access->admit(kPublishFrames, "10.0.0.7", token)->shareName("10.0.0.7"), "a");
}

TEST_F(Access, keepsTheSharesOfTokensAndJwtsApart) {
  const SigningKey key = SigningKey::ed25519();
  writeKeys(json::array({key.jwk()}));
  const std::string token = add("anna");
  const auto access = open();
  const auto by_token = access->admit(kListStreams, "peer", token);
  const auto by_jwt = access->admit(kListStreams, "peer", jwt(key));
  ASSERT_TRUE(by_token.ok() && by_jwt.ok()) << by_jwt.status();
  EXPECT_EQ(by_token->identity().id, by_jwt->identity().id);
  EXPECT_NE(by_token->shareName("peer"), by_jwt->shareName("peer"));
}

TEST_F(Access, forgetsARevokedToken) {
  const std::string token = add("a");
  const auto access = open();
  const auto caller = access->admit(kListStreams, "peer", token);
  ASSERT_TRUE(caller.ok());
  ASSERT_TRUE(removeFromTokenFile(tokens_, "a").ok());
  waitForLook();
  EXPECT_EQ(access->admit(kListStreams, "peer", token).status().code(), kUnauthenticated);
  EXPECT_EQ(caller->recheck().code(), kUnauthenticated);
}

TEST_F(Access, noticesANewTokenUnderAnOldName) {
  const std::string token = add("a");
  const auto access = open();
  const auto caller = access->admit(kListStreams, "peer", token);
  ASSERT_TRUE(removeFromTokenFile(tokens_, "a").ok());
  const std::string other = add("a");
  waitForLook();
  EXPECT_EQ(caller->recheck().code(), kUnauthenticated);
  EXPECT_TRUE(access->admit(kListStreams, "peer", other).ok());
}

TEST_F(Access, noticesOtherRights) {
  const std::string token = add("a");
  const auto access = open();
  const auto caller = access->admit(kListStreams, "peer", token);
  std::string text = *readSmallFile(tokens_, 10000);
  const size_t at = text.find("\"publish\",");
  std::ofstream(tokens_) << text.replace(at, 10, "");
  waitForLook();
  EXPECT_THAT(std::string(caller->recheck().message()), HasSubstr("rights"));
  EXPECT_EQ(access->admit(kPublishFrames, "peer", token).status().code(),
            absl::StatusCode::kPermissionDenied);
}

TEST_F(Access, endsATokenAtItsTime) {
  const std::string token = add("a", kNow_s + 10);
  const auto access = open();
  const auto caller = access->admit(kListStreams, "peer", token);
  ASSERT_TRUE(caller.ok());
  now_s_ += 10;
  EXPECT_THAT(std::string(access->admit(kListStreams, "peer", token).status().message()),
              HasSubstr("has expired"));
  EXPECT_EQ(caller->recheck().code(), kUnauthenticated);
}

TEST_F(Access, keepsTheOldFileWhileTheNewOneIsBad) {
  const std::string token = add("a");
  const std::string good = *readSmallFile(tokens_, 10000);
  const auto access = open();
  for (const char* text : {"nonsense\n", "{}"}) {
    std::ofstream(tokens_) << text;
    waitForLook();
    EXPECT_TRUE(access->admit(kListStreams, "peer", token).ok());
  }
  std::filesystem::remove(tokens_);
  waitForLook();
  EXPECT_TRUE(access->admit(kListStreams, "peer", token).ok());
  EXPECT_THAT(auditText(), HasSubstr("stays in force"));
  std::ofstream(tokens_) << "# none any more\n";
  waitForLook();
  EXPECT_EQ(access->admit(kListStreams, "peer", token).status().code(), kUnauthenticated);
}

TEST_F(Access, doesNotStartWithABadFile) {
  std::ofstream(tokens_) << "nonsense\n";
  EXPECT_THROW(open(), std::runtime_error);
  EXPECT_THROW(AccessControl({.token_file = folder_ / "nowhere"}, clock_), std::runtime_error);
  writeKeys(json::array({SigningKey::ed25519().jwk()}));
  EXPECT_THROW(AccessControl({.jwks_file = keys_}, clock_), std::runtime_error);
  EXPECT_THROW(AccessControl({.jwks_file = keys_, .audience = "a"}, clock_), std::runtime_error);
}

TEST_F(Access, takesJwtsOfTheKeysThatThereAre) {
  const SigningKey old_key = SigningKey::ed25519();
  const SigningKey new_key = SigningKey::p256();
  writeKeys(json::array({old_key.jwk("1")}));
  const auto access = open();
  const auto caller = access->admit(kStreamAtlases, "peer", jwt(old_key));
  ASSERT_TRUE(caller.ok()) << caller.status();
  EXPECT_TRUE(caller->mayUse("room.1").ok());
  EXPECT_EQ(caller->mayUse("hall").code(), absl::StatusCode::kPermissionDenied);
  EXPECT_EQ(access->admit(kStreamAtlases, "peer", jwt(new_key)).status().code(), kUnauthenticated);
  std::ofstream(keys_) << "nonsense";
  waitForLook();
  EXPECT_TRUE(access->admit(kStreamAtlases, "peer", jwt(old_key)).ok());
  EXPECT_THAT(auditText(), HasSubstr("stays in force"));
  writeKeys(json::array({new_key.jwk("2")}));
  waitForLook();
  EXPECT_EQ(caller->recheck().code(), kUnauthenticated);
  EXPECT_TRUE(access->admit(kStreamAtlases, "peer", jwt(new_key)).ok());
  now_s_ += 600;
  EXPECT_EQ(caller->recheck().code(), kUnauthenticated);
}

TEST_F(Access, signsLinksThatEndWithTheirToken) {
  const std::string token = add("a", kNow_s + 100);
  const auto access = open();
  const auto caller = access->admit(kApiLink, "peer", token);
  const auto link = access->sign(*caller, target_, 300);
  ASSERT_TRUE(link.ok()) << link.status();
  EXPECT_EQ(link->expires_s, kNow_s + 100);
  const auto linked = [&] {
    return access->admitLink("/still/x", "peer", link->signature, target_);
  };
  ASSERT_TRUE(linked().ok()) << linked().status();
  EXPECT_TRUE(linked()->mayUse("room.1").ok());
  EXPECT_EQ(
      access->admitLink("/still/x", "peer", link->signature, {"room.2", "quilt"}).status().code(),
      kUnauthenticated);
  ASSERT_TRUE(removeFromTokenFile(tokens_, "a").ok());
  waitForLook();
  EXPECT_EQ(linked().status().code(), kUnauthenticated);
  add("a");  // the same name does not revive it
  waitForLook();
  EXPECT_EQ(linked().status().code(), kUnauthenticated);
}

TEST_F(Access, signsLinksThatExpire) {
  const std::string token = add("a");
  const auto access = open();
  const auto caller = access->admit(kApiLink, "peer", token);
  const auto link = access->sign(*caller, target_, 10);
  now_s_ += 10;
  EXPECT_THAT(
      std::string(access->admitLink("/stream/x", "p", link->signature, target_).status().message()),
      HasSubstr("the link has expired"));
  for (const int64_t seconds : {int64_t{0}, int64_t{-1}, kLinkSecondsMax + 1, INT64_MAX}) {
    EXPECT_EQ(access->sign(*caller, target_, seconds).status().code(),
              absl::StatusCode::kInvalidArgument);
  }
}

TEST_F(Access, endsCallersWithTheirLink) {
  const std::string token = add("a");
  const auto access = open();
  const auto signer = access->admit(kApiLink, "peer", token);
  const auto link = access->sign(*signer, target_, 10);
  const auto caller = access->admitLink("/stream/x", "peer", link->signature, target_);
  ASSERT_TRUE(caller.ok()) << caller.status();
  now_s_ += 9;
  EXPECT_TRUE(caller->recheck().ok());
  now_s_ += 1;
  EXPECT_EQ(caller->recheck().code(), kUnauthenticated);
  EXPECT_THAT(std::string(caller->recheck().message()), HasSubstr("the link has expired"));
  EXPECT_TRUE(signer->recheck().ok());
}

TEST_F(Access, signsLinksForJwts) {
  const SigningKey key = SigningKey::ed25519();
  writeKeys(json::array({key.jwk()}));
  const auto access = open();
  const auto caller = access->admit(kApiLink, "peer", jwt(key));
  const auto link = access->sign(*caller, target_, 60);
  ASSERT_TRUE(link.ok());
  EXPECT_TRUE(access->admitLink("/still/x", "peer", link->signature, target_).ok());
  writeKeys(json::array({SigningKey::ed25519().jwk()}));
  waitForLook();
  EXPECT_FALSE(access->admitLink("/still/x", "peer", link->signature, target_).ok());
}

TEST_F(Access, auditsGrantsAndRefusalsWithoutSecrets) {
  Rights rights = allRights();
  rights.streams = StreamPatterns::parse({"room.*"}).value();
  const std::string token = add("camera-1", {}, rights);
  const auto access = open();
  const auto caller = access->admit(kPublishFrames, "10.0.0.7", token);
  EXPECT_TRUE(caller->mayUse("room.1").ok());
  EXPECT_FALSE(caller->mayUse("hall").ok());
  const std::string wrong = makeToken();
  EXPECT_FALSE(access->admit(kStreamAtlases, "10.0.0.8", wrong).ok());
  const std::string text = auditText();
  EXPECT_EQ(std::ranges::count(text, '\n'), 3);
  EXPECT_THAT(text, HasSubstr(R"("outcome":"granted","operation":"/viewloom.v1.IngestService/)"));
  EXPECT_THAT(text,
              HasSubstr(R"("peer":"10.0.0.7","proof":"token","id":"camera-1","stream":"hall")"));
  EXPECT_THAT(text, HasSubstr(R"("peer":"10.0.0.8","reason":"the access token is unknown)"));
  for (const std::string& secret : {token, wrong, hexText(sha256(token))}) {
    EXPECT_THAT(text, Not(HasSubstr(secret)));
  }
}

}  // namespace viewloom::access_control_test
