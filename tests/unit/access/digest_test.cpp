// SPDX-License-Identifier: Apache-2.0
#include "access/digest.h"

#include <gtest/gtest.h>

#include "access/utc_time.h"

namespace viewloom::digest_test {

TEST(Digest, isThatOfTheStandard) {
  // FIPS 180-2, and RFC 4231 case 2 with its key filled up with zeros.
  EXPECT_EQ(hexText(sha256("abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  Digest key{};
  key[0] = 'J';
  key[1] = 'e';
  key[2] = 'f';
  key[3] = 'e';
  EXPECT_EQ(hexText(hmacSha256(key, "what do ya want for nothing?")),
            "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843");
}

TEST(Digest, readsOnlyItsOwnHexadecimalText) {
  const std::string text = hexText(sha256("abc"));
  EXPECT_EQ(digestFromHex(text), sha256("abc"));
  EXPECT_FALSE(digestFromHex(text.substr(1)));
  EXPECT_FALSE(digestFromHex(text + "0"));
  EXPECT_FALSE(digestFromHex("BA" + text.substr(2)));
  EXPECT_FALSE(digestFromHex("zz" + text.substr(2)));
}

TEST(Digest, readsOnlyItsOwnBase64Url) {
  const std::string bytes("\xff\xfe\x00\x01", 4);
  EXPECT_EQ(base64Url(bytes), "__4AAQ");
  EXPECT_EQ(bytesFromBase64Url("__4AAQ"), bytes);
  EXPECT_EQ(bytesFromBase64Url(""), "");
  for (const char* text : {"__4AAQ==", "__4AAR", "__4A AQ", "//4AAQ", "_", "\xc3\xa4"}) {
    EXPECT_FALSE(bytesFromBase64Url(text)) << text;
  }
}

TEST(Digest, makesSecretsThatDiffer) {
  EXPECT_FALSE(areEqual(randomSecret(), randomSecret()));
  const Digest secret = randomSecret();
  EXPECT_TRUE(areEqual(secret, secret));
}

TEST(UtcTime, readsWhatItWrites) {
  EXPECT_EQ(utcText(1801396800), "2027-01-31T12:00:00Z");
  EXPECT_EQ(secondsFromUtc("2027-01-31T12:00:00Z"), 1801396800);
  EXPECT_EQ(secondsFromUtc("2027-01-31"), 1801396800 - 12 * 3600);
  for (const char* text : {"", "2027", "2027-02-31", "2027-01-31T12:00:00", "2027-01-31T12:00:00Zx",
                           "2027-01-31T12:00:00+01:00", " 2027-01-31"}) {
    EXPECT_FALSE(secondsFromUtc(text)) << text;
  }
}

}  // namespace viewloom::digest_test
