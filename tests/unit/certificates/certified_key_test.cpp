// SPDX-License-Identifier: Apache-2.0
#include "certificates/certified_key.h"

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/test_certificates.h"

namespace viewloom::certified_key_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class CertifiedKeyTest : public testing::Test {
 protected:
  CertifiedKeyTest() {
    std::string name = (std::filesystem::temp_directory_path() / "certified-key-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~CertifiedKeyTest() override { std::filesystem::remove_all(folder_); }

  void write(const TestCertificate& certificate) {
    writeText(folder_ / "server.crt", certificate.pem);
    writeText(folder_ / "server.key", certificate.key_pem);
  }

  absl::StatusOr<CertifiedKey> read(CertificatePurpose purpose = CertificatePurpose::kServer) {
    return readCertifiedKey(
        {.certificate = {.option = "tls.certificate", .path = folder_ / "server.crt"},
         .key = {.option = "tls.key", .path = folder_ / "server.key"}},
        purpose, kTestDay_s);
  }

  std::string refusal(CertificatePurpose purpose = CertificatePurpose::kServer) {
    const absl::Status status = read(purpose).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(status.message()), Not(HasSubstr("\n")));
    EXPECT_THAT(std::string(status.message()), Not(HasSubstr("MIG")));  // of a key in PEM
    return std::string(status.message());
  }

  std::filesystem::path folder_;
};

TEST_F(CertifiedKeyTest, isReadWithItsChain) {
  const TestCertificate authority = makeTestCertificate({.name = "lab", .is_authority = true});
  TestCertificate server = makeTestCertificate({.name = "studio"}, &authority);
  server.pem += authority.pem;
  write(server);
  const auto certified_key = read();
  ASSERT_TRUE(certified_key.ok()) << certified_key.status();
  EXPECT_EQ(certified_key->certificate.subject(), "CN=studio");
  EXPECT_EQ(certified_key->chain_pem, server.pem);
  EXPECT_EQ(certified_key->key_pem, server.key_pem);
}

TEST_F(CertifiedKeyTest, mayStandInOneFile) {
  const TestCertificate server = makeTestCertificate({});
  writeText(folder_ / "both.pem", server.key_pem + server.pem);
  const NamedFile file{.option = "tls.certificate", .path = folder_ / "both.pem"};
  const NamedFile key{.option = "tls.key", .path = folder_ / "both.pem"};
  EXPECT_TRUE(
      readCertifiedKey({.certificate = file, .key = key}, CertificatePurpose::kServer, kTestDay_s)
          .ok());
}

TEST_F(CertifiedKeyTest, isRefusedOutsideItsValidity) {
  write(makeTestCertificate({.end_s = kTestDay_s - 1}));
  EXPECT_THAT(refusal(), AllOf(HasSubstr("tls.certificate"), HasSubstr("server.crt"),
                               HasSubstr("expired on 2026-11-27"), HasSubstr("renew it")));
  write(makeTestCertificate({.begin_s = kTestDay_s + 86400}));
  EXPECT_THAT(refusal(), HasSubstr("valid from 2026-11-28 on, and today is 2026-11-27"));
}

TEST_F(CertifiedKeyTest, isRefusedForAnotherPurpose) {
  write(makeTestCertificate({.usage = "clientAuth"}));
  EXPECT_THAT(refusal(), HasSubstr("not made for a server"));
  EXPECT_TRUE(read(CertificatePurpose::kClient).ok());
  write(makeTestCertificate({.usage = "serverAuth"}));
  EXPECT_THAT(refusal(CertificatePurpose::kClient),
              AllOf(HasSubstr("not made for a client"), HasSubstr("ask the server's operator")));
}

TEST_F(CertifiedKeyTest, ofServersNamesAHost) {
  write(makeTestCertificate({.hosts = ""}));
  EXPECT_THAT(refusal(), AllOf(HasSubstr("names no host"), HasSubstr("--name HOST")));
  write(makeTestCertificate({.hosts = "", .usage = "clientAuth"}));
  EXPECT_TRUE(read(CertificatePurpose::kClient).ok());
}

TEST_F(CertifiedKeyTest, isRefusedWithoutItsOwnKey) {
  const TestCertificate other = makeTestCertificate({});
  TestCertificate server = makeTestCertificate({});
  server.key_pem = other.key_pem;
  write(server);
  EXPECT_THAT(refusal(),
              AllOf(HasSubstr("tls.key"), HasSubstr("does not belong"), HasSubstr("server.crt")));
  server.key_pem = makeTestCertificate({.rsa_bits = 2048}).key_pem;
  write(server);
  EXPECT_THAT(refusal(), HasSubstr("does not belong"));
}

TEST_F(CertifiedKeyTest, isRefusedWhenAFileIsMissing) {
  write(makeTestCertificate({}));
  std::filesystem::remove(folder_ / "server.key");
  EXPECT_THAT(refusal(),
              AllOf(HasSubstr("tls.key"), HasSubstr("No such file"), HasSubstr("check the path")));
  const auto no_key = readCertifiedKey({.certificate = {.option = "tls.certificate", .path = "a"},
                                        .key = {.option = "tls.key", .path = ""}},
                                       CertificatePurpose::kServer, kTestDay_s);
  EXPECT_THAT(std::string(no_key.status().message()),
              AllOf(HasSubstr("tls.key is missing"), HasSubstr("name both files")));
}

TEST_F(CertifiedKeyTest, isRefusedWhenFilesAreSwappedOrNoPem) {
  const TestCertificate server = makeTestCertificate({});
  write({.pem = server.key_pem, .key_pem = server.pem});
  EXPECT_THAT(refusal(), HasSubstr("holds a private key and no certificate"));
  write({.pem = server.pem, .key_pem = server.pem});
  EXPECT_THAT(refusal(), HasSubstr("holds no private key"));
  write({.pem = "", .key_pem = server.key_pem});
  EXPECT_THAT(refusal(), HasSubstr("holds no certificate"));
  write({.pem = std::string(100, '\0'), .key_pem = server.key_pem});
  EXPECT_THAT(refusal(), HasSubstr("holds no certificate"));
  write({.pem = server.pem, .key_pem = server.key_pem.substr(0, 90)});
  EXPECT_THAT(refusal(), HasSubstr("the private key is damaged"));
}

TEST_F(CertifiedKeyTest, isNeverAskedForAPassphrase) {
  TestCertificate server = makeTestCertificate({});
  server.key_pem = protectedKey(server.key_pem);
  write(server);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("protected by a passphrase"), HasSubstr("openssl pkey")));
}

TEST_F(CertifiedKeyTest, isRefusedWhenTooWeak) {
  write(makeTestCertificate({.rsa_bits = 1024}));
  EXPECT_THAT(refusal(), AllOf(HasSubstr("key too small"), HasSubstr("RSA of 2048 bits")));
}

TEST_F(CertifiedKeyTest, comesFromSmallRegularFiles) {
  write(makeTestCertificate({}));
  std::filesystem::remove(folder_ / "server.key");
  mkfifo((folder_ / "server.key").c_str(), 0600);
  EXPECT_THAT(refusal(), HasSubstr("no regular file"));
  writeText(folder_ / "server.crt", std::string((1 << 20) + 1, 'a'));
  EXPECT_THAT(refusal(), HasSubstr("accepted are up to 1048576 bytes"));
}

}  // namespace
}  // namespace viewloom::certified_key_test
