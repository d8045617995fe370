// SPDX-License-Identifier: Apache-2.0
#include "certificates/fingerprint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::fingerprint_test {
namespace {

constexpr const char* kText =
    "00:11:22:33:44:55:66:77:88:99:AA:BB:CC:DD:EE:FF:"
    "00:11:22:33:44:55:66:77:88:99:AA:BB:CC:DD:EE:FF";

TEST(Fingerprint, isReadInAllFormsThatToolsPrint) {
  const std::string digits = "00112233445566778899aabbccddeeff00112233445566778899AABBCCDDEEFF";
  for (const std::string& text :
       {std::string(kText), digits, "SHA256:" + digits, "sha256:" + std::string(kText)}) {
    const absl::StatusOr<Fingerprint> read = Fingerprint::parse(text);
    ASSERT_TRUE(read.ok()) << text;
    EXPECT_EQ(read->text(), kText);
  }
}

TEST(Fingerprint, refusesOtherTexts) {
  const std::string text = kText;
  for (const std::string& bad :
       {std::string(), std::string("SHA256:"), text.substr(3), text + ":00", text + "0", ":" + text,
        text + ":", "0" + text, text.substr(0, 60) + "G" + text.substr(61), text + " ",
        "00::" + text.substr(4)}) {
    const absl::Status status = Fingerprint::parse(bad).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << bad;
    EXPECT_THAT(std::string(status.message()), testing::HasSubstr("64 hexadecimal digits"));
  }
}

}  // namespace
}  // namespace viewloom::fingerprint_test
