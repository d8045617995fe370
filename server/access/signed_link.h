// SPDX-License-Identifier: Apache-2.0
// Links for <img> and players, which send no token: a signature stands in their address.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "access/identity.h"

namespace viewloom {

// A link shows one display of one stream.
struct LinkTarget {
  std::string stream;   // its name, which holds no line break
  std::string display;  // everything that changes the picture (displayKey, encoding)
};

// Claims of a link. Nothing of it is proven before isSigned().
struct LinkClaim {
  Proof proof = Proof::kToken;
  std::string id;  // of the identity that asked for the link
  int64_t expires_s = 0;
  std::string signature;
};

// "1893456000.t.Y2FtZXJhLTE.3q2-..."; INVALID_ARGUMENT for other texts.
absl::StatusOr<LinkClaim> parseLink(std::string_view text);

// Signs with HMAC-SHA256 and a secret that dies with the process, so links do, too. The digest of
// the identity is part of the signature: a new token of the same id does not revive old links.
// Thread-safety: may be called from any thread.
class LinkSigner {
 public:
  std::string sign(const Identity& identity, const LinkTarget& target, int64_t expires_s) const;
  bool isSigned(const LinkClaim& claim, const Identity& identity, const LinkTarget& target) const;

 private:
  Digest signature(const Identity& identity, const LinkTarget& target, int64_t expires_s) const;

  const Digest secret_ = randomSecret();
};

}  // namespace viewloom
