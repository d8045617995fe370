// SPDX-License-Identifier: Apache-2.0
#include "support/test_certificates.h"

#include <fstream>

#include <openssl/ec.h>
#include <openssl/pem.h>
#include <openssl/rsa.h>

#include "base/check.h"
#include "certificates/openssl.h"

namespace viewloom {
namespace {

OpensslPtr<EVP_PKEY> keyOf(const std::string& pem) {
  return OpensslPtr<EVP_PKEY>(
      PEM_read_bio_PrivateKey(readingBio(pem).get(), nullptr, nullptr, nullptr));
}

OpensslPtr<X509> certificateOf(const std::string& pem) {
  return OpensslPtr<X509>(PEM_read_bio_X509(readingBio(pem).get(), nullptr, nullptr, nullptr));
}

void extend(X509& certificate, int kind, const std::string& value) {
  if (value.empty()) return;
  const OpensslPtr<X509_EXTENSION> extension(
      X509V3_EXT_conf_nid(nullptr, nullptr, kind, value.c_str()));
  VIEWLOOM_CHECK(X509_add_ext(&certificate, extension.get(), -1) == 1);
}

}  // namespace

TestCertificate makeTestCertificate(const TestCertificateWish& wish,
                                    const TestCertificate* issuer) {
  static long serial = 0;
  const OpensslPtr<EVP_PKEY> key(wish.rsa_bits == 0 ? EVP_EC_gen("P-256")
                                                    : EVP_RSA_gen(wish.rsa_bits));
  const OpensslPtr<X509> certificate(X509_new());
  X509_set_version(certificate.get(), 2);
  ASN1_INTEGER_set(X509_get_serialNumber(certificate.get()), ++serial);
  ASN1_TIME_set(X509_getm_notBefore(certificate.get()), wish.begin_s);
  ASN1_TIME_set(X509_getm_notAfter(certificate.get()), wish.end_s);
  X509_NAME* const name = X509_get_subject_name(certificate.get());
  X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_UTF8,
                             reinterpret_cast<const unsigned char*>(wish.name.c_str()), -1, -1, 0);
  const OpensslPtr<X509> signer = issuer ? certificateOf(issuer->pem) : nullptr;
  X509_set_issuer_name(certificate.get(), signer ? X509_get_subject_name(signer.get()) : name);
  X509_set_pubkey(certificate.get(), key.get());
  extend(*certificate, NID_basic_constraints,
         wish.is_authority ? "critical,CA:TRUE" : "critical,CA:FALSE");
  extend(*certificate, NID_key_usage, wish.is_authority ? "keyCertSign" : "digitalSignature");
  extend(*certificate, NID_ext_key_usage, wish.is_authority ? "" : wish.usage);
  extend(*certificate, NID_subject_alt_name, wish.is_authority ? "" : wish.hosts);
  const OpensslPtr<EVP_PKEY> signing = issuer ? keyOf(issuer->key_pem) : nullptr;
  VIEWLOOM_CHECK(X509_sign(certificate.get(), signing ? signing.get() : key.get(), EVP_sha256()) >
                 0);
  const OpensslPtr<BIO> pem = writingBio();
  const OpensslPtr<BIO> key_pem = writingBio();
  PEM_write_bio_X509(pem.get(), certificate.get());
  PEM_write_bio_PrivateKey(key_pem.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr);
  return {.pem = bytesOf(*pem), .key_pem = bytesOf(*key_pem)};
}

std::string protectedKey(const std::string& key_pem) {
  const OpensslPtr<BIO> pem = writingBio();
  const unsigned char passphrase[] = "secret";
  PEM_write_bio_PrivateKey(pem.get(), keyOf(key_pem).get(), EVP_aes_128_cbc(), passphrase, 6,
                           nullptr, nullptr);
  return bytesOf(*pem);
}

void writeText(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace viewloom
