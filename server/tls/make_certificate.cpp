// SPDX-License-Identifier: Apache-2.0
#include "tls/make_certificate.h"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

#include <openssl/ec.h>
#include <openssl/pem.h>
#include <openssl/rand.h>

#include "absl/strings/ascii.h"
#include "base/str_cat.h"
#include "certificates/openssl.h"

namespace viewloom {
namespace {

constexpr int64_t kDay_s = 86400;
// Clocks of machines differ.
constexpr int64_t kBegunBefore_s = 3600;
constexpr size_t kHostNameBytesMax = 253;
constexpr size_t kCommonNameBytesMax = 64;
constexpr long kVersion3 = 2;

// Fails only for want of memory or of random numbers.
void require(bool is_done) {
  if (!is_done) {
    throw std::runtime_error(strCat("OpenSSL makes no certificate: ", opensslReason()));
  }
}

bool isAddress(const std::string& host) {
  in6_addr address{};
  return inet_pton(AF_INET, host.c_str(), &address) == 1 ||
         inet_pton(AF_INET6, host.c_str(), &address) == 1;
}

bool isHostName(const std::string& host) {
  std::string_view rest = host;
  if (rest.starts_with("*.")) rest.remove_prefix(2);
  const bool is_plain = std::ranges::all_of(rest, [](char character) {
    return absl::ascii_isalnum(static_cast<unsigned char>(character)) || character == '-' ||
           character == '.' || character == '_';
  });
  return is_plain && !rest.empty() && rest.size() <= kHostNameBytesMax && rest.front() != '.' &&
         rest.find("..") == std::string_view::npos;
}

absl::Status checkWish(const CertificateWish& wish) {
  if (wish.hosts.empty()) {
    return invalidField("host", "none is given; accepted is at least one name or address");
  }
  for (const std::string& host : wish.hosts) {
    if (isAddress(host) || isHostName(host)) continue;
    return invalidField("host", strCat("got \"", host,
                                       "\"; accepted is a host name such as studio.local, or an "
                                       "address without brackets and port"));
  }
  if (wish.days < 1 || wish.days > kCertificateDaysMax) {
    return invalidField("days",
                        strCat("got ", wish.days, "; accepted are 1..", kCertificateDaysMax));
  }
  return absl::OkStatus();
}

// All characters of hosts are plain, so the text cannot hold another entry.
std::string alternativeNames(const std::vector<std::string>& hosts) {
  std::string text;
  for (const std::string& host : hosts) {
    text += strCat(text.empty() ? "" : ",", isAddress(host) ? "IP:" : "DNS:", host);
  }
  return text;
}

void addExtension(X509& certificate, int kind, const std::string& value) {
  X509V3_CTX context{};
  X509V3_set_ctx(&context, &certificate, &certificate, nullptr, nullptr, 0);
  const OpensslPtr<X509_EXTENSION> extension(
      X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str()));
  require(extension != nullptr && X509_add_ext(&certificate, extension.get(), -1) == 1);
}

void setSerial(X509& certificate) {
  std::array<unsigned char, 16> random{};
  require(RAND_bytes(random.data(), static_cast<int>(random.size())) == 1);
  random.front() &= 0x7f;  // positive
  BIGNUM* const number = BN_bin2bn(random.data(), static_cast<int>(random.size()), nullptr);
  const bool is_set = number != nullptr &&
                      BN_to_ASN1_INTEGER(number, X509_get_serialNumber(&certificate)) != nullptr;
  BN_free(number);
  require(is_set);
}

void setName(X509& certificate, const std::string& host) {
  X509_NAME* const name = X509_get_subject_name(&certificate);
  const std::string common = host.substr(0, kCommonNameBytesMax);
  require(X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_UTF8,
                                     reinterpret_cast<const unsigned char*>(common.c_str()), -1, -1,
                                     0) == 1);
  require(X509_set_issuer_name(&certificate, name) == 1);
}

OpensslPtr<X509> signedCertificate(const CertificateWish& wish, EVP_PKEY& key) {
  OpensslPtr<X509> certificate(X509_new());
  require(certificate != nullptr && X509_set_version(certificate.get(), kVersion3) == 1);
  setSerial(*certificate);
  setName(*certificate, wish.hosts.front());
  const int64_t begin_s = wish.now_s - kBegunBefore_s;
  const int64_t end_s = wish.now_s + wish.days * kDay_s;
  require(ASN1_TIME_set(X509_getm_notBefore(certificate.get()), begin_s) != nullptr &&
          ASN1_TIME_set(X509_getm_notAfter(certificate.get()), end_s) != nullptr);
  require(X509_set_pubkey(certificate.get(), &key) == 1);
  addExtension(*certificate, NID_basic_constraints, "critical,CA:FALSE");
  addExtension(*certificate, NID_key_usage, "critical,digitalSignature");
  addExtension(*certificate, NID_ext_key_usage, "serverAuth");
  addExtension(*certificate, NID_subject_key_identifier, "hash");
  addExtension(*certificate, NID_authority_key_identifier, "keyid:always");
  addExtension(*certificate, NID_subject_alt_name, alternativeNames(wish.hosts));
  require(X509_sign(certificate.get(), &key, EVP_sha256()) > 0);
  return certificate;
}

}  // namespace

absl::StatusOr<MadeCertificate> makeCertificate(const CertificateWish& wish) {
  VIEWLOOM_RETURN_IF_ERROR(checkWish(wish));
  const OpensslPtr<EVP_PKEY> key(EVP_EC_gen("P-256"));
  require(key != nullptr);
  const OpensslPtr<X509> certificate = signedCertificate(wish, *key);
  const OpensslPtr<BIO> certificate_pem = writingBio();
  const OpensslPtr<BIO> key_pem = writingBio();
  require(PEM_write_bio_X509(certificate_pem.get(), certificate.get()) == 1);
  require(PEM_write_bio_PrivateKey(key_pem.get(), key.get(), nullptr, nullptr, 0, nullptr,
                                   nullptr) == 1);
  return MadeCertificate{.certificate_pem = bytesOf(*certificate_pem),
                         .key_pem = bytesOf(*key_pem),
                         .fingerprint = Fingerprint::of(*certificate)};
}

}  // namespace viewloom
