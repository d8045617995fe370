// SPDX-License-Identifier: Apache-2.0
#include "certificates/fingerprint.h"

#include "absl/strings/ascii.h"
#include "base/check.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr std::array<std::string_view, 2> kPrefixes{"SHA256:", "sha256:"};

// Value of a hexadecimal digit; -1 for other characters.
int digitOf(char character) {
  if (character >= '0' && character <= '9') return character - '0';
  const char lower = absl::ascii_tolower(static_cast<unsigned char>(character));
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

absl::Status notFingerprint(std::string_view text) {
  return absl::InvalidArgumentError(
      strCat("got \"", text,
             "\"; accepted is the SHA-256 fingerprint of a certificate, 64 hexadecimal digits, "
             "which `viewloomd certificate` and `viewloomd serve` print"));
}

}  // namespace

Fingerprint Fingerprint::of(const X509& certificate) {
  Fingerprint result;
  unsigned size = 0;
  const int done = X509_digest(&certificate, EVP_sha256(), result.bytes_.data(), &size);
  VIEWLOOM_CHECK(done == 1 && size == result.bytes_.size());
  return result;
}

absl::StatusOr<Fingerprint> Fingerprint::parse(std::string_view text) {
  std::string_view rest = text;
  for (const std::string_view prefix : kPrefixes) {
    if (rest.starts_with(prefix)) rest.remove_prefix(prefix.size());
  }
  Fingerprint result;
  size_t at = 0;
  for (uint8_t& byte : result.bytes_) {
    if (at > 0 && at < rest.size() && rest[at] == ':') ++at;
    if (at + 2 > rest.size()) return notFingerprint(text);
    const int high = digitOf(rest[at]);
    const int low = digitOf(rest[at + 1]);
    if (high < 0 || low < 0) return notFingerprint(text);
    byte = static_cast<uint8_t>(16 * high + low);
    at += 2;
  }
  if (at != rest.size()) return notFingerprint(text);
  return result;
}

std::string Fingerprint::text() const {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string text;
  for (const uint8_t byte : bytes_) {
    if (!text.empty()) text += ':';
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

}  // namespace viewloom
