// SPDX-License-Identifier: Apache-2.0
#include "certificates/authorities.h"

#include <unistd.h>

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/test_certificates.h"

namespace viewloom::authorities_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class AuthoritiesTest : public testing::Test {
 protected:
  absl::Status check(const std::string& shown_pem, const std::string& host = "localhost") const {
    const auto chain = parseCertificates(shown_pem);
    const auto authorities = Authorities::make(authority_.pem);
    EXPECT_TRUE(chain.ok() && authorities.ok());
    return authorities->checkServer(*chain, host, kTestDay_s);
  }
  std::string refusal(const std::string& shown_pem, const std::string& host = "localhost") const {
    const absl::Status status = check(shown_pem, host);
    EXPECT_EQ(status.code(), absl::StatusCode::kUnauthenticated);
    return std::string(status.message());
  }
  std::string shown(const TestCertificateWish& wish) const {
    return makeTestCertificate(wish, &authority_).pem;
  }

  const TestCertificate authority_ = makeTestCertificate({.name = "lab", .is_authority = true});
};

TEST_F(AuthoritiesTest, acceptWhatTheySigned) {
  EXPECT_TRUE(check(shown({})).ok());
  EXPECT_TRUE(check(shown({}), "127.0.0.1").ok());
  const TestCertificate between =
      makeTestCertificate({.name = "studio", .is_authority = true}, &authority_);
  const std::string leaf = makeTestCertificate({}, &between).pem;
  EXPECT_TRUE(check(leaf + between.pem).ok());
  EXPECT_FALSE(check(leaf).ok());
}

TEST_F(AuthoritiesTest, acceptACertificateThatIsTrustedItself) {
  const TestCertificate own = makeTestCertificate({});
  const auto authorities = Authorities::make(own.pem);
  EXPECT_TRUE(authorities->checkServer(*parseCertificates(own.pem), "localhost", kTestDay_s).ok());
}

TEST_F(AuthoritiesTest, refuseWhatOthersSigned) {
  EXPECT_THAT(refusal(makeTestCertificate({}).pem),
              AllOf(HasSubstr("self-signed"), HasSubstr("--tls-ca"), HasSubstr("--fingerprint")));
  const TestCertificate other = makeTestCertificate({.name = "lab", .is_authority = true});
  EXPECT_FALSE(check(makeTestCertificate({}, &other).pem).ok());
  // A server's certificate signs nothing.
  const TestCertificate server = makeTestCertificate({}, &authority_);
  EXPECT_FALSE(check(makeTestCertificate({}, &server).pem + server.pem).ok());
}

TEST_F(AuthoritiesTest, refuseExpiredOtherPurposesAndOtherNames) {
  EXPECT_THAT(refusal(shown({.end_s = kTestDay_s - 1})),
              AllOf(HasSubstr("expired"), HasSubstr("renew the server's certificate")));
  EXPECT_THAT(refusal(shown({.begin_s = kTestDay_s + 1})), HasSubstr("check the clocks"));
  EXPECT_THAT(refusal(shown({.usage = "clientAuth"})), HasSubstr("made for servers"));
  EXPECT_THAT(refusal(shown({}), "studio.local"),
              AllOf(HasSubstr("of studio.local is made for localhost, 127.0.0.1"),
                    HasSubstr("connect by a name that it has")));
  EXPECT_THAT(refusal(shown({.hosts = ""})), HasSubstr("made for no host"));
  EXPECT_THAT(refusal(""), HasSubstr("no certificate"));
}

TEST_F(AuthoritiesTest, comeFromAFileOfCertificates) {
  std::string name = (std::filesystem::temp_directory_path() / "authorities-XXXXXX").string();
  const std::filesystem::path folder = mkdtemp(name.data());
  const NamedFile file{.option = "--tls-ca", .path = folder / "ca.pem"};
  writeText(folder / "ca.pem", authority_.pem);
  EXPECT_EQ(*readAuthorities(file, kTestDay_s), authority_.pem);
  EXPECT_THAT(std::string(readAuthorities(file, kTestDay_s + 90'000).status().message()),
              AllOf(HasSubstr("--tls-ca"), HasSubstr("all its certificates have expired")));
  writeText(folder / "ca.pem", "words");
  EXPECT_THAT(std::string(readAuthorities(file, kTestDay_s).status().message()),
              HasSubstr("holds no certificate"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace viewloom::authorities_test
