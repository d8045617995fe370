// SPDX-License-Identifier: Apache-2.0
#include "tls/tls_watch.h"

#include <unistd.h>

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/test_certificates.h"

namespace viewloom::tls_watch_test {
namespace {

using Found = TlsStore::Found;
using testing::HasSubstr;

class TlsStoreTest : public testing::Test {
 protected:
  TlsStoreTest() {
    std::string name = (std::filesystem::temp_directory_path() / "tls-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    files_ = {.certificate = folder_ / "server.crt", .key = folder_ / "server.key"};
    replace(makeTestCertificate({.name = "first"}));
  }
  ~TlsStoreTest() override { std::filesystem::remove_all(folder_); }

  // Tools write a file under another name first.
  void replaceFile(const char* name, const std::string& text) const {
    writeText(folder_ / "new", text);
    std::filesystem::rename(folder_ / "new", folder_ / name);
  }
  void replace(const TestCertificate& certificate) const {
    replaceFile("server.crt", certificate.pem);
    replaceFile("server.key", certificate.key_pem);
  }
  TlsStore store() const {
    return TlsStore(files_, [] { return kTestDay_s; });
  }

  std::filesystem::path folder_;
  TlsFiles files_;
};

std::string subjectOf(const TlsStore& store) {
  return store.current()->certified_key.certificate.subject();
}

TEST_F(TlsStoreTest, takesChangedFilesOnceTheyStand) {
  TlsStore store(files_, [] { return kTestDay_s; });
  EXPECT_EQ(subjectOf(store), "CN=first");
  EXPECT_EQ(*store.look(), Found::kNothing);
  const TestCertificate second = makeTestCertificate({.name = "second"});
  replaceFile("server.crt", second.pem);
  EXPECT_EQ(*store.look(), Found::kNothing);  // the key has not come yet
  replaceFile("server.key", second.key_pem);
  EXPECT_EQ(*store.look(), Found::kNothing);
  EXPECT_EQ(*store.look(), Found::kTaken);
  EXPECT_EQ(subjectOf(store), "CN=second");
  EXPECT_EQ(*store.look(), Found::kNothing);
}

TEST_F(TlsStoreTest, keepsWhatItHasWhenNewFilesAreBad) {
  TlsStore store(files_, [] { return kTestDay_s; });
  replaceFile("server.key", makeTestCertificate({}).key_pem);
  EXPECT_TRUE(store.look().ok());
  const absl::Status status = store.look().status();
  EXPECT_THAT(std::string(status.message()), HasSubstr("does not belong"));
  EXPECT_EQ(*store.look(), Found::kNothing);  // told once
  EXPECT_EQ(subjectOf(store), "CN=first");
  std::filesystem::remove(folder_ / "server.crt");
  EXPECT_TRUE(store.look().ok());
  EXPECT_THAT(std::string(store.look().status().message()), HasSubstr("cannot be read"));
  EXPECT_EQ(subjectOf(store), "CN=first");
  replace(makeTestCertificate({.name = "second"}));
  EXPECT_TRUE(store.look().ok());
  EXPECT_EQ(*store.look(), Found::kTaken);
  EXPECT_EQ(subjectOf(store), "CN=second");
}

TEST_F(TlsStoreTest, takesFilesThatBecomeGood) {
  int64_t now_s = kTestDay_s;
  TlsStore store(files_, [&] { return now_s; });
  replace(makeTestCertificate({.name = "second", .begin_s = kTestDay_s + 10}));
  EXPECT_TRUE(store.look().ok());
  EXPECT_THAT(std::string(store.look().status().message()), HasSubstr("is valid from"));
  EXPECT_EQ(*store.look(), Found::kNothing);
  now_s += 10;
  EXPECT_EQ(*store.look(), Found::kTaken);
  EXPECT_EQ(subjectOf(store), "CN=second");
}

TEST_F(TlsStoreTest, readsAuthoritiesOfClients) {
  files_.client_authorities = folder_ / "clients.crt";
  const TestCertificate authority = makeTestCertificate({.name = "lab", .is_authority = true});
  writeText(files_.client_authorities, authority.pem);
  TlsStore store(files_, [] { return kTestDay_s; });
  EXPECT_EQ(store.current()->client_authorities_pem, authority.pem);
  writeText(files_.client_authorities, "none");
  EXPECT_TRUE(store.look().ok());
  EXPECT_THAT(std::string(store.look().status().message()), HasSubstr("tls.client_ca"));
  EXPECT_EQ(store.current()->client_authorities_pem, authority.pem);
}

TEST_F(TlsStoreTest, needsACertificateBesideAuthoritiesOfClients) {
  const absl::Status status =
      readTlsMaterial({.client_authorities = "clients.crt"}, kTestDay_s).status();
  EXPECT_THAT(std::string(status.message()), HasSubstr("without tls.certificate"));
}

TEST_F(TlsStoreTest, doesNotBeginWithBadFiles) {
  replace(makeTestCertificate({.end_s = kTestDay_s - 1}));
  EXPECT_THROW(store(), std::runtime_error);
}

TEST_F(TlsStoreTest, isWatchedFromItsConstructionOn) {
  replace(makeTestCertificate({.begin_s = 0, .end_s = 4'000'000'000}));
  int64_t told_s = 0;
  const TlsWatch watch(files_, [&](const auto& found, int64_t end_s) {
    EXPECT_EQ(*found, Found::kNothing);
    told_s = end_s;
  });
  EXPECT_EQ(told_s, 4'000'000'000);
  EXPECT_NE(watch.current(), nullptr);
}

}  // namespace
}  // namespace viewloom::tls_watch_test
