// SPDX-License-Identifier: Apache-2.0
// OpenSSL's objects with owners, and its errors in words.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

namespace viewloom {

struct OpensslFree {
  void operator()(ASN1_OCTET_STRING* object) const { ASN1_OCTET_STRING_free(object); }
  void operator()(BIO* object) const { BIO_free_all(object); }
  void operator()(EVP_PKEY* object) const { EVP_PKEY_free(object); }
  void operator()(GENERAL_NAMES* object) const { GENERAL_NAMES_free(object); }
  void operator()(SSL_CTX* object) const { SSL_CTX_free(object); }
  void operator()(X509* object) const { X509_free(object); }
  void operator()(X509_EXTENSION* object) const { X509_EXTENSION_free(object); }
  void operator()(X509_STORE* object) const { X509_STORE_free(object); }
  void operator()(X509_STORE_CTX* object) const { X509_STORE_CTX_free(object); }
};

template <typename Object>
using OpensslPtr = std::unique_ptr<Object, OpensslFree>;

// Reads `bytes` in place; they must outlive it.
OpensslPtr<BIO> readingBio(std::string_view bytes);
// Holds what is written to it.
OpensslPtr<BIO> writingBio();
std::string bytesOf(BIO& bio);

// Reason of the newest failure on this thread ("ee key too small"), which is forgotten with all
// earlier ones; "unknown reason" without one.
std::string opensslReason();

}  // namespace viewloom
