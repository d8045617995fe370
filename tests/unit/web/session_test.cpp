// SPDX-License-Identifier: Apache-2.0
#include "web/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include <nlohmann/json.hpp>

#include "access/token_file.h"
#include "unit/web/no_eyes.h"
#include "web/admission.h"

namespace viewloom::session_test {

using testing::HasSubstr;
using testing::Not;

TEST(TokenOfARequest, comesFromItsHeaders) {
  EXPECT_EQ(tokenOf({}), "");
  EXPECT_EQ(tokenOf({.authorization = "Bearer abc"}), "abc");
  EXPECT_EQ(tokenOf({.authorization = "bearer  abc "}), "abc");
  EXPECT_EQ(tokenOf({.authorization = "Basic abc"}), "");
  EXPECT_EQ(tokenOf({.authorization = "Bearer"}), "");
  EXPECT_EQ(tokenOf({.cookie = "a=b; viewloom_token=abc; c=d"}), "abc");
  EXPECT_EQ(tokenOf({.cookie = "xviewloom_token=abc"}), "");
  EXPECT_EQ(tokenOf({.websocket_protocols = "viewloom, bearer.a.b.c"}), "a.b.c");
  // The header says it most clearly.
  EXPECT_EQ(tokenOf({.authorization = "Bearer a", .cookie = "viewloom_token=b"}), "a");
  EXPECT_EQ(tokenOf({.cookie = "viewloom_token=b", .websocket_protocols = "bearer.c"}), "c");
  // An address never holds a token.
  EXPECT_EQ(tokenOf({.target = "/api/streams?token=abc&access_token=abc"}), "");
}

TEST(WebSocketProtocol, isChosenWhereItIsOffered) {
  EXPECT_TRUE(offersProtocol({.websocket_protocols = "bearer.x,viewloom"}));
  EXPECT_FALSE(offersProtocol({.websocket_protocols = "viewloom2"}));
  EXPECT_FALSE(offersProtocol({}));
}

class Session : public testing::Test {
 protected:
  Session() {
    std::filesystem::remove(path_);
    Rights rights = allRights();
    rights.roles = {Role::kWatch};
    rights.streams = StreamPatterns::parse({"room.*"}).value();
    const auto identity = std::make_shared<Identity>(Identity{.id = "anna",
                                                              .proof = Proof::kToken,
                                                              .rights = rights,
                                                              .digest = sha256(token_),
                                                              .expires_s = {}});
    EXPECT_TRUE(addToTokenFile(path_, {.identity = identity, .note = ""}).ok());
    access_.emplace(AccessOptions{.token_file = path_}, clock_);
    const auto healthy = [] { return absl::OkStatus(); };
    context_.emplace(HttpOptions{}, HostPolicy({}, {}, {}), healthy, streams_, broadcaster_, eyes_,
                     metrics_, clock_, *access_, unboundedMemory(), shares_);
    for (const char* name : {"room.1", "hall"}) claims_.push_back(*streams_.claim(name, "", [] {}));
  }
  ~Session() override { std::filesystem::remove(path_); }

  HttpReply ask(const std::string& method, HttpRequest request) const {
    request.method = method;
    request.target = "/api/session";
    return answerSession(*context_, request);
  }
  static std::string cookieOf(const HttpReply& reply) {
    for (const auto& [name, value] : reply.headers) {
      if (name == "Set-Cookie") return value;
    }
    return "";
  }
  // The status of a link for the target.
  HttpReply link(const std::string& target) const {
    return answerLink(*context_, {.authorization = "Bearer " + token_},
                      {.path = "/api/link", .parameters = {{"target", target}}});
  }
  absl::StatusOr<AdmittedPicture> open(const std::string& address, const std::string& cookie = "",
                                       const QuiltAddressForm& form = stillForm()) {
    const HttpRequest request{.method = "GET", .target = address, .cookie = cookie};
    return admitPicture(*context_, request, *parseUrl(address), form);
  }

  const std::string path_ = std::filesystem::temp_directory_path() /
                            ("viewloom_session_test_" + std::to_string(getpid()));
  const std::string token_ = makeToken();
  ManualClock clock_;
  Metrics metrics_;
  StreamDirectory streams_{clock_, 4};
  Broadcaster broadcaster_{BroadcasterLimits{}};
  NoEyes eyes_;
  FairShares shares_;
  std::optional<AccessControl> access_;
  std::optional<WebContext> context_;
  std::vector<std::unique_ptr<StreamDirectory::Claim>> claims_;
};

TEST_F(Session, beginsWithATokenInAHeader) {
  const HttpReply reply = ask("POST", {.authorization = "Bearer " + token_});
  EXPECT_EQ(reply.status, 200U);
  EXPECT_EQ(cookieOf(reply), "viewloom_token=" + token_ + "; Path=/; HttpOnly; SameSite=Strict");
  EXPECT_THAT(reply.text, Not(HasSubstr(token_)));
  const auto answer = nlohmann::json::parse(reply.text);
  EXPECT_EQ(answer["id"], "anna");
  EXPECT_EQ(answer["roles"][0], "watch");
  EXPECT_TRUE(answer["needs_token"]);
  EXPECT_THAT(cookieOf(ask("POST", {.authorization = "Bearer " + token_, .is_encrypted = true})),
              HasSubstr("; Secure"));
}

TEST_F(Session, doesNotBeginWithAWrongToken) {
  for (const HttpRequest& request :
       {HttpRequest{}, HttpRequest{.authorization = "Bearer " + makeToken()},
        HttpRequest{.cookie = "viewloom_token=" + token_}}) {
    const HttpReply reply = ask("POST", request);
    EXPECT_EQ(reply.status, 401U);
    EXPECT_EQ(cookieOf(reply), "");
  }
}

TEST_F(Session, goesOnByItsCookieAndEnds) {
  EXPECT_EQ(ask("GET", {.cookie = "viewloom_token=" + token_}).status, 200U);
  EXPECT_EQ(ask("GET", {}).status, 401U);
  EXPECT_THAT(cookieOf(ask("DELETE", {})), HasSubstr("viewloom_token=; Path=/"));
  EXPECT_THAT(cookieOf(ask("DELETE", {})), HasSubstr("Max-Age=0"));
}

TEST_F(Session, needsATokenForAPicture) {
  EXPECT_EQ(open("/still/room.1/portrait").status().code(), absl::StatusCode::kUnauthenticated);
  EXPECT_TRUE(open("/still/room.1/portrait", "viewloom_token=" + token_).ok());
  // Whether there is a stream that is not its own, it does not learn.
  for (const char* stream : {"hall", "attic"}) {
    const absl::Status status =
        open(std::string("/still/") + stream + "/portrait", "viewloom_token=" + token_).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kPermissionDenied);
  }
  const absl::Status unknown = open("/still/room.2/portrait", "viewloom_token=" + token_).status();
  EXPECT_EQ(unknown.code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(unknown.message()), Not(HasSubstr("hall")));
}

TEST_F(Session, makesLinksForOnePicture) {
  const HttpReply reply = link("/still/room.1/portrait");
  ASSERT_EQ(reply.status, 200U) << reply.text;
  const std::string url = nlohmann::json::parse(reply.text)["url"];
  EXPECT_THAT(url, testing::StartsWith("/still/room.1_qs8x6a0.75.jpg?preset=portrait&link="));
  EXPECT_TRUE(open(url).ok()) << open(url).status();
  const std::string signature = "?" + url.substr(url.find("link="));
  EXPECT_EQ(open("/still/room.1/go_p" + signature).status().code(),
            absl::StatusCode::kUnauthenticated);
  EXPECT_EQ(open("/still/room.2/portrait" + signature).status().code(),
            absl::StatusCode::kUnauthenticated);
  EXPECT_EQ(open("/stream/room.1/portrait" + signature, "", streamForm()).status().code(),
            absl::StatusCode::kUnauthenticated);
  // Another spelling of the same picture redirects, and keeps the link.
  const auto other = open("/still/room.1/portrait" + signature);
  ASSERT_TRUE(other.ok()) << other.status();
  EXPECT_THAT(other->address.redirect, HasSubstr("link="));
}

// Browsers send no fragment, and JSON holds no bytes that are no UTF-8.
TEST_F(Session, makesLinksOfPlainText) {
  for (const std::string target : {"/still/room.1_qs8x6a0.75.jpg?preset=portrait#\xff",
                                   "/still/room.1.jpg?display={\"stereo\": {\"eye_size\": "
                                   "{\"width\": 64, \"height\": 32}}}#x"}) {
    const HttpReply reply = link(target);
    ASSERT_EQ(reply.status, 200U) << reply.text;
    const std::string url = nlohmann::json::parse(reply.text)["url"];
    EXPECT_THAT(url, Not(HasSubstr("#")));
    EXPECT_THAT(url, Not(HasSubstr(" ")));
    EXPECT_TRUE(open(url).ok()) << open(url).status();
  }
}

TEST_F(Session, makesNoOtherLinks) {
  EXPECT_EQ(link("/still/hall/portrait").status, 403U);
  EXPECT_EQ(link("/still/room.2/portrait").status, 404U);
  EXPECT_EQ(link("/metrics").status, 400U);
  EXPECT_EQ(link("").status, 400U);
  EXPECT_EQ(answerQr(*context_, {.host = "h"}, {.path = "/api/qr", .parameters = {}}).status, 401U);
  EXPECT_EQ(answerLink(*context_, {}, {.path = "/api/link", .parameters = {}}).status, 401U);
}

}  // namespace viewloom::session_test
