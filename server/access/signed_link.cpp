// SPDX-License-Identifier: Apache-2.0
#include "access/signed_link.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <vector>

#include "absl/strings/str_split.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr std::string_view kTokenLetter = "t";
constexpr std::string_view kJwtLetter = "j";
constexpr size_t kLinkBytesMax = 512;

std::string_view letterOf(Proof proof) {
  return proof == Proof::kJwt ? kJwtLetter : kTokenLetter;
}

}  // namespace

absl::StatusOr<LinkClaim> parseLink(std::string_view text) {
  const absl::Status damaged =
      invalidField("link", "the signature of the link is damaged; ask for a new link");
  if (text.size() > kLinkBytesMax) return damaged;
  const std::vector<std::string> parts = absl::StrSplit(asAbslPart(text), '.');
  if (parts.size() != 4 || (parts[1] != kTokenLetter && parts[1] != kJwtLetter)) return damaged;
  LinkClaim claim;
  const char* const end = parts[0].data() + parts[0].size();
  const auto [stop, error] = std::from_chars(parts[0].data(), end, claim.expires_s);
  const std::optional<std::string> id = bytesFromBase64Url(parts[2]);
  const std::optional<std::string> signature = bytesFromBase64Url(parts[3]);
  if (error != std::errc() || stop != end || !id || !signature ||
      signature->size() != Digest().size()) {
    return damaged;
  }
  claim.proof = parts[1] == kJwtLetter ? Proof::kJwt : Proof::kToken;
  claim.id = *id;
  claim.signature = *signature;
  return claim;
}

Digest LinkSigner::signature(const Identity& identity, const LinkTarget& target,
                             int64_t expires_s) const {
  // The display is the last part, and only it may hold a line break.
  return hmacSha256(secret_, strCat("viewloom link\n", letterOf(identity.proof), "\n", expires_s,
                                    "\n", base64Url(identity.id), "\n", hexText(identity.digest),
                                    "\n", target.stream, "\n", target.display));
}

std::string LinkSigner::sign(const Identity& identity, const LinkTarget& target,
                             int64_t expires_s) const {
  return strCat(expires_s, ".", letterOf(identity.proof), ".", base64Url(identity.id), ".",
                base64Url(signature(identity, target, expires_s)));
}

bool LinkSigner::isSigned(const LinkClaim& claim, const Identity& identity,
                          const LinkTarget& target) const {
  if (claim.id != identity.id || claim.proof != identity.proof) return false;
  Digest given{};
  if (claim.signature.size() != given.size()) return false;
  std::ranges::copy(claim.signature, given.begin());
  return areEqual(given, signature(identity, target, claim.expires_s));
}

}  // namespace viewloom
