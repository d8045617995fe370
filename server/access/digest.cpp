// SPDX-License-Identifier: Apache-2.0
#include "access/digest.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>

#include <algorithm>
#include <stdexcept>

#include "absl/strings/escaping.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

void require(bool is_done, const char* what) {
  if (!is_done) throw std::runtime_error(std::string("OpenSSL could not make ") + what);
}

bool isLowerHex(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
}

std::string_view bytesOf(const Digest& digest) {
  return {reinterpret_cast<const char*>(digest.data()), digest.size()};
}

}  // namespace

Digest sha256(std::string_view bytes) {
  Digest digest{};
  require(
      EVP_Digest(bytes.data(), bytes.size(), digest.data(), nullptr, EVP_sha256(), nullptr) == 1,
      "a SHA-256 digest");
  return digest;
}

Digest hmacSha256(const Digest& key, std::string_view bytes) {
  Digest digest{};
  const unsigned char* const data = reinterpret_cast<const unsigned char*>(bytes.data());
  require(HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()), data, bytes.size(),
               digest.data(), nullptr) != nullptr,
          "an HMAC");
  return digest;
}

Digest randomSecret() {
  Digest secret{};
  require(RAND_priv_bytes(secret.data(), static_cast<int>(secret.size())) == 1, "random bytes");
  return secret;
}

bool areEqual(const Digest& one, const Digest& other) {
  return CRYPTO_memcmp(one.data(), other.data(), one.size()) == 0;
}

std::string hexText(const Digest& digest) {
  return absl::BytesToHexString(asAbslPart(bytesOf(digest)));
}

std::optional<Digest> digestFromHex(std::string_view text) {
  Digest digest{};
  if (text.size() != 2 * digest.size() || !std::ranges::all_of(text, isLowerHex)) {
    return std::nullopt;
  }
  const std::string bytes = absl::HexStringToBytes(asAbslPart(text));
  std::ranges::copy(bytes, digest.begin());
  return digest;
}

std::string base64Url(std::string_view bytes) {
  return absl::WebSafeBase64Escape(asAbslPart(bytes));
}

std::string base64Url(const Digest& digest) {
  return base64Url(bytesOf(digest));
}

std::optional<std::string> bytesFromBase64Url(std::string_view text) {
  std::string bytes;
  if (!absl::WebSafeBase64Unescape(asAbslPart(text), &bytes)) return std::nullopt;
  // The parser also takes padding, blanks and bits that stand for nothing.
  if (base64Url(bytes) != text) return std::nullopt;
  return bytes;
}

}  // namespace viewloom
