// SPDX-License-Identifier: Apache-2.0
// Digests, keyed digests and random secrets of 256 bits, made by OpenSSL.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace viewloom {

using Digest = std::array<uint8_t, 32>;

// All functions throw std::runtime_error if OpenSSL fails. Thread-safety: may be called from any
// thread.
Digest sha256(std::string_view bytes);
Digest hmacSha256(const Digest& key, std::string_view bytes);
// 256 bits that nobody can guess.
Digest randomSecret();

// Compares in a time that does not depend on the bytes.
bool areEqual(const Digest& one, const Digest& other);

// 64 lower-case hexadecimal digits.
std::string hexText(const Digest& digest);
std::optional<Digest> digestFromHex(std::string_view text);

// base64url without padding (RFC 4648, section 5).
std::string base64Url(std::string_view bytes);
std::string base64Url(const Digest& digest);
// Empty for other characters, padding, and texts that base64Url does not write.
std::optional<std::string> bytesFromBase64Url(std::string_view text);

}  // namespace viewloom
