// SPDX-License-Identifier: Apache-2.0
#include "tls/make_certificate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/x509v3.h>

#include "certificates/authorities.h"
#include "certificates/certificate.h"
#include "support/test_certificates.h"

namespace viewloom::make_certificate_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(MakeCertificate, isForItsHostsForSoManyDays) {
  const auto made =
      makeCertificate({.hosts = {"studio.local", "*.lab.example", "10.0.0.5", "fd00::5"},
                       .days = 30,
                       .now_s = kTestDay_s});
  ASSERT_TRUE(made.ok()) << made.status();
  const auto read = parseCertificates(made->certificate_pem);
  ASSERT_EQ(read->size(), 1U);
  const Certificate& certificate = read->front();
  EXPECT_EQ(certificate.subject(), "CN=studio.local");
  EXPECT_THAT(certificate.names(),
              ElementsAre("studio.local", "*.lab.example", "10.0.0.5", "fd00::5"));
  EXPECT_EQ(certificate.endS(), kTestDay_s + 30 * 86400);
  EXPECT_LT(certificate.beginS(), kTestDay_s);
  EXPECT_TRUE(certificate.isFor(CertificatePurpose::kServer));
  EXPECT_EQ(X509_check_ca(&certificate.get()), 0) << "it may sign others";
  EXPECT_TRUE(certificate.isSelfSigned());
  EXPECT_EQ(certificate.fingerprint(), made->fingerprint);
  EXPECT_TRUE(Authorities::make(made->certificate_pem)
                  ->checkServer(*read, "studio.local", kTestDay_s)
                  .ok());
}

TEST(MakeCertificate, isAnotherOneEachTime) {
  const CertificateWish wish{.hosts = {"a"}, .now_s = kTestDay_s};
  const auto first = makeCertificate(wish);
  const auto second = makeCertificate(wish);
  EXPECT_NE(first->key_pem, second->key_pem);
  EXPECT_NE(first->fingerprint, second->fingerprint);
}

TEST(MakeCertificate, refusesHostsThatAreNone) {
  for (const char* host : {"", "a b", "a,IP:1.2.3.4", "10.0.0.5:443", "[::1]", ".a", "a..b", "*.",
                           "a\nb", "http://a", "a*b"}) {
    const absl::Status status = makeCertificate({.hosts = {"good", host}}).status();
    EXPECT_EQ(fieldOf(status), "host") << host;
  }
  EXPECT_FALSE(makeCertificate({.hosts = {std::string(254, 'a')}}).ok());
  EXPECT_THAT(std::string(makeCertificate({}).status().message()), HasSubstr("at least one"));
}

TEST(MakeCertificate, takesLongNames) {
  const std::string host = std::string(60, 'a') + "." + std::string(60, 'b');
  const auto made = makeCertificate({.hosts = {host}, .now_s = kTestDay_s});
  ASSERT_TRUE(made.ok());
  EXPECT_TRUE(parseCertificates(made->certificate_pem)->front().isFor(host));
}

TEST(MakeCertificate, refusesOtherDays) {
  for (const uint32_t days : {0U, kCertificateDaysMax + 1}) {
    EXPECT_EQ(fieldOf(makeCertificate({.hosts = {"a"}, .days = days}).status()), "days");
  }
}

}  // namespace
}  // namespace viewloom::make_certificate_test
