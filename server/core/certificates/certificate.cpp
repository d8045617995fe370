// SPDX-License-Identifier: Apache-2.0
#include "certificates/certificate.h"

#include <arpa/inet.h>

#include <ctime>

#include <openssl/err.h>
#include <openssl/pem.h>

#include "base/check.h"

namespace viewloom {
namespace {

int64_t secondsOf(const ASN1_TIME* time) {
  std::tm parts{};
  VIEWLOOM_CHECK(ASN1_TIME_to_tm(time, &parts) == 1);
  return timegm(&parts);
}

std::string addressText(const ASN1_OCTET_STRING& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  const int size = ASN1_STRING_length(&address);
  if (size != 4 && size != 16) return "";
  const int family = size == 4 ? AF_INET : AF_INET6;
  inet_ntop(family, ASN1_STRING_get0_data(&address), text.data(), text.size());
  return text.data();
}

std::string textOf(const GENERAL_NAME& name) {
  int kind = 0;
  const void* const value = GENERAL_NAME_get0_value(&name, &kind);
  if (kind == GEN_IPADD) return addressText(*static_cast<const ASN1_OCTET_STRING*>(value));
  if (kind != GEN_DNS) return "";
  const auto* const text = static_cast<const ASN1_IA5STRING*>(value);
  return {reinterpret_cast<const char*>(ASN1_STRING_get0_data(text)),
          static_cast<size_t>(ASN1_STRING_length(text))};
}

}  // namespace

std::string Certificate::subject() const {
  const OpensslPtr<BIO> bio = writingBio();
  X509_NAME_print_ex(bio.get(), X509_get_subject_name(certificate_.get()), 0, XN_FLAG_RFC2253);
  return bytesOf(*bio);
}

std::vector<std::string> Certificate::names() const {
  const OpensslPtr<GENERAL_NAMES> found(static_cast<GENERAL_NAMES*>(
      X509_get_ext_d2i(certificate_.get(), NID_subject_alt_name, nullptr, nullptr)));
  std::vector<std::string> names;
  for (int i = 0; i < sk_GENERAL_NAME_num(found.get()); ++i) {
    std::string name = textOf(*sk_GENERAL_NAME_value(found.get(), i));
    if (!name.empty()) names.push_back(std::move(name));
  }
  return names;
}

bool Certificate::isFor(const std::string& host) const {
  in6_addr address{};
  const bool is_address = inet_pton(AF_INET, host.c_str(), &address) == 1 ||
                          inet_pton(AF_INET6, host.c_str(), &address) == 1;
  if (is_address) return X509_check_ip_asc(certificate_.get(), host.c_str(), 0) == 1;
  // A name in the subject alone counts nowhere any more.
  return X509_check_host(certificate_.get(), host.data(), host.size(),
                         X509_CHECK_FLAG_NEVER_CHECK_SUBJECT, nullptr) == 1;
}

bool Certificate::isFor(CertificatePurpose purpose) const {
  const int id =
      purpose == CertificatePurpose::kServer ? X509_PURPOSE_SSL_SERVER : X509_PURPOSE_SSL_CLIENT;
  return X509_check_purpose(certificate_.get(), id, 0) == 1;
}

bool Certificate::isSelfSigned() const {
  return X509_self_signed(certificate_.get(), 0) == 1;
}

int64_t Certificate::beginS() const {
  return secondsOf(X509_get0_notBefore(certificate_.get()));
}

int64_t Certificate::endS() const {
  return secondsOf(X509_get0_notAfter(certificate_.get()));
}

absl::StatusOr<std::vector<Certificate>> parseCertificates(std::string_view pem) {
  const OpensslPtr<BIO> bio = readingBio(pem);
  std::vector<Certificate> certificates;
  ERR_clear_error();
  while (X509* const read = PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr)) {
    certificates.emplace_back(OpensslPtr<X509>(read));
    // Times that cannot be read would be found too late.
    std::tm parts{};
    if (ASN1_TIME_to_tm(X509_get0_notBefore(read), &parts) != 1 ||
        ASN1_TIME_to_tm(X509_get0_notAfter(read), &parts) != 1) {
      return absl::InvalidArgumentError("a certificate is damaged: its validity is no time");
    }
  }
  const bool is_end = ERR_GET_REASON(ERR_peek_last_error()) == PEM_R_NO_START_LINE;
  const std::string reason = opensslReason();
  if (!is_end) return absl::InvalidArgumentError("a certificate is damaged: " + reason);
  return certificates;
}

std::string dayText(int64_t time_s) {
  const std::time_t time = time_s;
  std::tm parts{};
  gmtime_r(&time, &parts);
  std::array<char, 16> text{};
  std::strftime(text.data(), text.size(), "%F", &parts);
  return text.data();
}

}  // namespace viewloom
