// SPDX-License-Identifier: Apache-2.0
#include "certificates/certified_key.h"

#include <utility>
#include <vector>

#include <openssl/err.h>
#include <openssl/pem.h>

#include "base/check.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

std::string newOne(CertificatePurpose purpose) {
  return purpose == CertificatePurpose::kServer
             ? "renew it, or make one with `viewloomd certificate`"
             : "ask the server's operator for a new one";
}

// Notes that a passphrase would be needed, and gives none: OpenSSL would ask on the terminal.
int refusePassphrase(char*, int, int, void* was_asked) {
  *static_cast<bool*>(was_asked) = true;
  return -1;
}

absl::StatusOr<OpensslPtr<EVP_PKEY>> parseKey(const NamedFile& file, const std::string& pem) {
  bool was_asked = false;
  const OpensslPtr<BIO> bio = readingBio(pem);
  OpensslPtr<EVP_PKEY> key(
      PEM_read_bio_PrivateKey(bio.get(), nullptr, refusePassphrase, &was_asked));
  if (key != nullptr) return key;
  const std::string reason = opensslReason();
  if (was_asked) {
    return file.error(
        "is protected by a passphrase; store it without one (openssl pkey -in KEY -out NEW), "
        "readable by the user of this program alone");
  }
  if (holdsPrivateKey(pem)) return file.error(strCat("the private key is damaged: ", reason));
  return file.error("holds no private key; accepted is a private key in PEM");
}

absl::StatusOr<std::vector<Certificate>> parseChain(const CertifiedKeyFiles& files,
                                                    const std::string& pem) {
  absl::StatusOr<std::vector<Certificate>> chain = parseCertificates(pem);
  if (!chain.ok()) return files.certificate.error(std::string(chain.status().message()));
  if (!chain->empty()) return chain;
  if (holdsPrivateKey(pem)) {
    return files.certificate.error(
        strCat("holds a private key and no certificate; name the "
               "certificate in ",
               files.certificate.option, " and the key in ", files.key.option));
  }
  return files.certificate.error("holds no certificate; accepted is a certificate in PEM");
}

absl::Status checkCertificate(const NamedFile& file, const Certificate& certificate,
                              CertificatePurpose purpose, int64_t now_s) {
  if (now_s > certificate.endS()) {
    return file.error(
        strCat("the certificate expired on ", dayText(certificate.endS()), "; ", newOne(purpose)));
  }
  if (now_s < certificate.beginS()) {
    return file.error(strCat("the certificate is valid from ", dayText(certificate.beginS()),
                             " on, and today is ", dayText(now_s),
                             "; check the clock of this machine, or wait"));
  }
  const bool is_server = purpose == CertificatePurpose::kServer;
  if (!certificate.isFor(purpose)) {
    return file.error(strCat("the certificate is not made for a ", is_server ? "server" : "client",
                             " (its key usage says so); ", newOne(purpose)));
  }
  if (is_server && certificate.names().empty()) {
    return file.error(
        "the certificate names no host, so that no client accepts it (subjectAltName is "
        "missing); make one with `viewloomd certificate --name HOST`");
  }
  return absl::OkStatus();
}

// Finds what a port would find later: keys that are too short, signatures that are too weak.
absl::Status checkUse(const CertifiedKeyFiles& files, const std::vector<Certificate>& chain,
                      EVP_PKEY& key) {
  const OpensslPtr<SSL_CTX> context(SSL_CTX_new(TLS_method()));
  VIEWLOOM_CHECK(context != nullptr);
  ERR_clear_error();
  bool is_taken = SSL_CTX_use_certificate(context.get(), &chain.front().get()) == 1;
  for (size_t i = 1; is_taken && i < chain.size(); ++i) {
    is_taken = SSL_CTX_add1_chain_cert(context.get(), &chain[i].get()) == 1;
  }
  if (!is_taken) {
    return files.certificate.error(
        strCat("OpenSSL refuses the certificate: ", opensslReason(),
               "; take one with a key of EC P-256 or RSA of 2048 bits, signed with SHA-256"));
  }
  if (SSL_CTX_use_PrivateKey(context.get(), &key) == 1) return absl::OkStatus();
  return files.key.error(
      strCat("OpenSSL refuses the private key: ", opensslReason(),
             "; take a key of EC P-256 or RSA of 2048 bits, and a certificate for it"));
}

absl::Status checkPair(const CertifiedKeyFiles& files, const Certificate& certificate,
                       EVP_PKEY& key) {
  const bool belongs = X509_check_private_key(&certificate.get(), &key) == 1;
  ERR_clear_error();
  if (belongs) return absl::OkStatus();
  return files.key.error(strCat("the key does not belong to the certificate ",
                                files.certificate.path, "; name the key that was made with it"));
}

}  // namespace

absl::StatusOr<CertifiedKey> readCertifiedKey(const CertifiedKeyFiles& files,
                                              CertificatePurpose purpose, int64_t now_s) {
  if (files.certificate.path.empty() || files.key.path.empty()) {
    const bool has_key = files.certificate.path.empty();
    const NamedFile& missing = has_key ? files.certificate : files.key;
    const NamedFile& given = has_key ? files.key : files.certificate;
    return absl::InvalidArgumentError(
        strCat(missing.option, " is missing: ", given.option,
               " is given, and a certificate is used with its private key; name both files"));
  }
  absl::StatusOr<std::string> chain_pem = readPemFile(files.certificate);
  VIEWLOOM_RETURN_IF_ERROR(chain_pem.status());
  absl::StatusOr<std::vector<Certificate>> chain = parseChain(files, *chain_pem);
  VIEWLOOM_RETURN_IF_ERROR(chain.status());
  absl::StatusOr<std::string> key_pem = readPemFile(files.key);
  VIEWLOOM_RETURN_IF_ERROR(key_pem.status());
  const absl::StatusOr<OpensslPtr<EVP_PKEY>> key = parseKey(files.key, *key_pem);
  VIEWLOOM_RETURN_IF_ERROR(key.status());
  VIEWLOOM_RETURN_IF_ERROR(checkPair(files, chain->front(), **key));
  VIEWLOOM_RETURN_IF_ERROR(checkCertificate(files.certificate, chain->front(), purpose, now_s));
  VIEWLOOM_RETURN_IF_ERROR(checkUse(files, *chain, **key));
  return CertifiedKey{.chain_pem = *std::move(chain_pem),
                      .key_pem = *std::move(key_pem),
                      .certificate = std::move(chain->front())};
}

}  // namespace viewloom
