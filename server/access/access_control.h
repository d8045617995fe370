// SPDX-License-Identifier: Apache-2.0
// Decides who may do what: proves identities, checks their rights, and writes the audit log.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "access/audit_log.h"
#include "access/caller.h"
#include "access/identity.h"
#include "access/jwt.h"
#include "access/operations.h"
#include "access/quota_ledger.h"
#include "access/signed_link.h"
#include "access/token_list.h"
#include "access/watched_file.h"
#include "base/clock.h"

namespace viewloom {

// Without a token file and a key file, everybody may do everything.
struct AccessOptions {
  std::string token_file;  // see token_list.h
  std::string jwks_file;   // see key_set.h; needs audience and issuer
  std::string audience;
  std::string issuer;
  std::string audit_file;
  WallClock now_s = systemSeconds;
};

// A signed link lives from 1 s to this long.
inline constexpr int64_t kLinkSecondsMax = 3600;

// Files are looked at again at most once a second. A changed file that is bad leaves the old
// content in force, and the log says so. Thread-safety: all methods may be called from any thread.
class AccessControl {
 public:
  // Throws std::runtime_error, with the remedy, if a file cannot be used. `clock` outlives it.
  AccessControl(AccessOptions options, const Clock& clock);
  // For servers that let everybody do everything.
  explicit AccessControl(const Clock& clock) : AccessControl(AccessOptions(), clock) {}

  bool isOn() const { return tokens_file_.has_value() || keys_file_.has_value(); }

  // Proves who calls, by a token or a JWT ("" = none came), and checks the role that the operation
  // needs. UNAUTHENTICATED without a proven identity, PERMISSION_DENIED without the role. An
  // unknown operation needs an identity, and grants nothing. The caller must not outlive this
  // object.
  absl::StatusOr<Caller> admit(std::string_view operation, std::string peer,
                               std::string_view token);
  // Likewise by a signed link to this target. The caller then ends with the link (Caller::recheck).
  // A server that lets everybody do everything looks at no link.
  absl::StatusOr<Caller> admitLink(std::string_view operation, std::string peer,
                                   std::string_view link, const LinkTarget& target);

  struct Link {
    std::string signature;
    int64_t expires_s = 0;
  };
  // A link that the caller may hand on, for `seconds`, and no longer than its identity lives.
  absl::StatusOr<Link> sign(const Caller& caller, const LinkTarget& target, int64_t seconds);

 private:
  friend class Caller;

  struct Sources {
    TokenList tokens;
    std::vector<PublicKey> keys;
  };
  using SourcesPtr = std::shared_ptr<const Sources>;

  SourcesPtr sources();
  void reload();
  absl::StatusOr<IdentityPtr> identify(std::string_view token);
  absl::StatusOr<IdentityPtr> linkedIdentity(const LinkClaim& claim, const LinkTarget& target);
  absl::StatusOr<Caller> grant(std::string_view operation, std::string peer,
                               const absl::StatusOr<IdentityPtr>& identity);
  // UNAUTHENTICATED once the identity has expired, was revoked, or has other rights.
  absl::Status recheck(const Identity& identity);
  // UNAUTHENTICATED once a link that expires then has expired.
  absl::Status checkLinkTime(int64_t expires_s) const;
  void audit(const AuditEvent& event) { audit_.write(event); }

  const AccessOptions options_;
  const Clock& clock_;
  AuditLog audit_;
  const LinkSigner signer_;
  QuotaLedger quotas_;

  std::mutex mutex_;
  std::optional<WatchedFile> tokens_file_;
  std::optional<WatchedFile> keys_file_;
  SourcesPtr sources_;
  int64_t next_look_ns_ = 0;
  std::map<std::string, IdentityPtr> linked_;  // proven by a JWT, by id: who has signed links
};

}  // namespace viewloom
