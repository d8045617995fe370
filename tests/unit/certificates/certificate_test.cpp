// SPDX-License-Identifier: Apache-2.0
#include "certificates/certificate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/test_certificates.h"

namespace viewloom::certificate_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Certificate made(const TestCertificateWish& wish) {
  auto parsed = parseCertificates(makeTestCertificate(wish).pem);
  return std::move(parsed->front());
}

TEST(Certificate, tellsWhatItIsFor) {
  const Certificate certificate = made(
      {.name = "studio", .hosts = "DNS:studio.local,DNS:*.lab.example,IP:10.0.0.5,IP:fd00::5"});
  EXPECT_EQ(certificate.subject(), "CN=studio");
  EXPECT_THAT(certificate.names(),
              ElementsAre("studio.local", "*.lab.example", "10.0.0.5", "fd00::5"));
  EXPECT_EQ(dayText(certificate.beginS()), "2026-11-26");
  EXPECT_EQ(certificate.endS(), kTestDay_s + 86400);
  EXPECT_TRUE(certificate.isFor(CertificatePurpose::kServer));
  EXPECT_FALSE(certificate.isFor(CertificatePurpose::kClient));
  EXPECT_TRUE(certificate.isSelfSigned());
}

TEST(Certificate, isForItsNamesAndAddressesAlone) {
  const Certificate certificate =
      made({.name = "other.local", .hosts = "DNS:studio.local,DNS:*.lab.example,IP:10.0.0.5"});
  for (const char* host : {"studio.local", "Studio.Local", "a.lab.example", "10.0.0.5"}) {
    EXPECT_TRUE(certificate.isFor(host)) << host;
  }
  for (const char* host : {"other.local", "lab.example", "a.b.lab.example", "10.0.0.6", "", "local",
                           "studio.local.evil.example", "::1"}) {
    EXPECT_FALSE(certificate.isFor(host)) << host;
  }
}

TEST(Certificate, comesFromTextsWithOtherBlocks) {
  const TestCertificate first = makeTestCertificate({.name = "first"});
  const TestCertificate second = makeTestCertificate({.name = "second"});
  const auto read = parseCertificates("words\n" + first.key_pem + first.pem + "\n" + second.pem);
  ASSERT_TRUE(read.ok()) << read.status();
  ASSERT_EQ(read->size(), 2U);
  EXPECT_EQ((*read)[1].subject(), "CN=second");
  EXPECT_TRUE(parseCertificates("")->empty());
  EXPECT_TRUE(parseCertificates(first.key_pem)->empty());
}

TEST(Certificate, isRefusedWhenDamaged) {
  const std::string pem = makeTestCertificate({}).pem;
  size_t refused_count = 0;
  for (size_t i = 0; i < pem.size(); i += 7) {
    std::string damaged = pem;
    damaged[i] = '!';
    const auto read = parseCertificates(damaged);
    if (read.ok()) continue;  // the first line is gone, or nothing that is checked here
    ++refused_count;
    EXPECT_THAT(std::string(read.status().message()), HasSubstr("damaged"));
  }
  EXPECT_GT(refused_count, 50U);
  EXPECT_FALSE(parseCertificates(pem.substr(0, pem.size() / 2)).ok());
}

}  // namespace
}  // namespace viewloom::certificate_test
