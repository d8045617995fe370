// SPDX-License-Identifier: Apache-2.0
#include "certificates/authorities.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <openssl/err.h>

#include "absl/strings/str_join.h"
#include "base/check.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

// The certificates of a chain after the first; they stay with the chain.
struct Between {
  explicit Between(const std::vector<Certificate>& chain) : stack(sk_X509_new_null()) {
    VIEWLOOM_CHECK(stack != nullptr);
    for (size_t i = 1; i < chain.size(); ++i) sk_X509_push(stack, &chain[i].get());
  }
  Between(const Between&) = delete;
  Between& operator=(const Between&) = delete;
  ~Between() { sk_X509_free(stack); }

  STACK_OF(X509) * stack;
};

std::string remedyOf(int error) {
  switch (error) {
    case X509_V_ERR_CERT_HAS_EXPIRED:
      return "renew the server's certificate";
    case X509_V_ERR_CERT_NOT_YET_VALID:
      return "check the clocks of both machines";
    case X509_V_ERR_INVALID_PURPOSE:
      return "the server needs a certificate made for servers";
    default:
      return "name the certificate of its authority with --tls-ca, or pin with --fingerprint what "
             "the server itself prints";
  }
}

}  // namespace

absl::StatusOr<std::string> readAuthorities(const NamedFile& file, int64_t now_s) {
  absl::StatusOr<std::string> pem = readPemFile(file);
  VIEWLOOM_RETURN_IF_ERROR(pem.status());
  const absl::StatusOr<std::vector<Certificate>> found = parseCertificates(*pem);
  if (!found.ok()) return file.error(std::string(found.status().message()));
  if (found->empty()) {
    return file.error("holds no certificate; accepted are certificates of authorities in PEM");
  }
  const bool has_valid =
      std::ranges::any_of(*found, [now_s](const Certificate& one) { return now_s <= one.endS(); });
  if (!has_valid) {
    return file.error(strCat("all its certificates have expired, the first on ",
                             dayText(found->front().endS()),
                             "; name the present certificate of the authority"));
  }
  return pem;
}

absl::StatusOr<Authorities> Authorities::make(const std::string& pem) {
  OpensslPtr<X509_STORE> store(X509_STORE_new());
  VIEWLOOM_CHECK(store != nullptr);
  // A server's own certificate may stand among the trusted ones.
  X509_STORE_set_flags(store.get(), X509_V_FLAG_PARTIAL_CHAIN | X509_V_FLAG_TRUSTED_FIRST);
  if (pem.empty()) {
    if (X509_STORE_set_default_paths(store.get()) != 1) {
      return absl::FailedPreconditionError(
          strCat("the system's certificates of authorities cannot be read: ", opensslReason()));
    }
    ERR_clear_error();  // of files that are not there
    return Authorities(std::move(store));
  }
  const absl::StatusOr<std::vector<Certificate>> trusted = parseCertificates(pem);
  VIEWLOOM_RETURN_IF_ERROR(trusted.status());
  for (const Certificate& certificate : *trusted) {
    X509_STORE_add_cert(store.get(), &certificate.get());
  }
  ERR_clear_error();
  return Authorities(std::move(store));
}

absl::Status Authorities::checkServer(const std::vector<Certificate>& chain,
                                      const std::string& host, int64_t now_s) const {
  if (chain.empty()) return absl::UnauthenticatedError("the server showed no certificate");
  const Certificate& shown = chain.front();
  const Between between(chain);
  const OpensslPtr<X509_STORE_CTX> check(X509_STORE_CTX_new());
  VIEWLOOM_CHECK(check != nullptr &&
                 X509_STORE_CTX_init(check.get(), store_.get(), &shown.get(), between.stack) == 1);
  X509_STORE_CTX_set_time(check.get(), 0, now_s);
  X509_STORE_CTX_set_default(check.get(), "ssl_server");
  if (X509_verify_cert(check.get()) != 1) {
    const int error = X509_STORE_CTX_get_error(check.get());
    ERR_clear_error();
    return absl::UnauthenticatedError(
        strCat("the certificate of ", host,
               " is not accepted: ", X509_verify_cert_error_string(error), "; ", remedyOf(error)));
  }
  if (shown.isFor(host)) return absl::OkStatus();
  const std::vector<std::string> names = shown.names();
  return absl::UnauthenticatedError(
      strCat("the certificate of ", host, " is made for ",
             names.empty() ? "no host" : absl::StrJoin(names, ", "),
             "; connect by a name that it has, or pin with --fingerprint what the server itself "
             "prints"));
}

}  // namespace viewloom
