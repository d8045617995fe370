// SPDX-License-Identifier: Apache-2.0
#include "lib/credentials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::credentials_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kAddress = "https://studio.local:50051";

std::string refusal(const std::string& address, const TlsOptions& options) {
  const absl::Status status = makeCredentials(address, options).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  return std::string(status.message());
}

TEST(Credentials, areMadeForPlainAndForEncryptedAddresses) {
  for (const char* address :
       {"127.0.0.1:50051", "unix:/run/viewloom", kAddress, "https://[::1]:1"}) {
    const auto credentials = makeCredentials(address, {});
    ASSERT_TRUE(credentials.ok()) << credentials.status();
    EXPECT_NE(*credentials, nullptr);
  }
  EXPECT_TRUE(makeCredentials(kAddress, {.fingerprint = std::string(64, 'a')}).ok());
}

TEST(Credentials, wantHttpsBesideOptionsOfTls) {
  for (const TlsOptions& options :
       {TlsOptions{.authorities_file = "a"}, TlsOptions{.certificate_file = "a"},
        TlsOptions{.key_file = "a"}, TlsOptions{.fingerprint = "a"}}) {
    EXPECT_THAT(refusal("studio.local:50051", options), HasSubstr("write it as https://HOST:PORT"));
  }
  EXPECT_THAT(refusal("https://studio.local", {}), HasSubstr("accepted is https://HOST:PORT"));
  EXPECT_THAT(refusal("https://unix:/run/viewloom", {}), HasSubstr("https://HOST:PORT"));
}

TEST(Credentials, nameTheOptionThatIsWrong) {
  EXPECT_THAT(refusal(kAddress, {.fingerprint = "12"}),
              AllOf(HasSubstr("--fingerprint"), HasSubstr("64 hexadecimal digits")));
  EXPECT_THAT(refusal(kAddress, {.authorities_file = "/none"}),
              AllOf(HasSubstr("--tls-ca /none"), HasSubstr("No such file")));
  EXPECT_THAT(refusal(kAddress, {.certificate_file = "/none"}), HasSubstr("--tls-key is missing"));
  EXPECT_THAT(refusal(kAddress, {.key_file = "/none"}), HasSubstr("--tls-cert is missing"));
}

}  // namespace
}  // namespace viewloom::credentials_test
