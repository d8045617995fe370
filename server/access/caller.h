// SPDX-License-Identifier: Apache-2.0
// A client of one call or request, with a proven identity.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "access/audit_log.h"
#include "access/identity.h"
#include "access/operations.h"
#include "access/quota_ledger.h"
#include "base/status.h"

namespace viewloom {

class AccessControl;

// Made by AccessControl::admit. Thread-safety: const methods may be called from any thread.
class Caller {
 public:
  const Identity& identity() const { return *identity_; }

  // Whether the caller may do what it asked for with this stream. PERMISSION_DENIED otherwise. The
  // audit log gets a line for both. Ask it before anything shows whether the stream exists.
  absl::Status mayUse(const std::string& stream) const;
  // Whether lists show the stream to the caller.
  bool sees(std::string_view stream) const;
  // Name of the one whose share of memory and engine time its calls take: the id of a token, or the
  // subject of a JWT ("anna (JWT)"). Where nobody has to prove one, it is the client at `host`
  // (identityOfHost).
  std::string shareName(std::string_view host) const;
  // UNAUTHENTICATED once its identity has expired, was revoked, or has other rights, and once the
  // signed link by which it came has expired.
  // RESOURCE_EXHAUSTED once it has gone over a rate of its quota. To be asked now and then while a
  // call lives; the call ends then.
  absl::Status recheck() const;

  // Parts of the identity's quota (quota_ledger.h). The audit log gets a line for each refusal.
  // The caller stays connected, as long as it or one of its copies lives.
  absl::Status stay();
  absl::StatusOr<QuotaPartPtr> holdStream(const std::string& name) const;
  absl::StatusOr<QuotaPartPtr> holdDisplay(const DisplayUse& use,
                                           const QuotaPart* replaced = nullptr) const;
  void noteBytes(uint64_t bytes) const;

 private:
  friend class AccessControl;

  Caller(AccessControl& access, std::string_view operation, std::string peer, IdentityPtr identity)
      : access_(&access),
        operation_(operation),
        peer_(std::move(peer)),
        identity_(std::move(identity)) {}

  AuditEvent event(AuditOutcome outcome) const;
  // Tells the audit log why not, if not.
  absl::Status told(const absl::Status& status, const std::string& stream = "") const;

  AccessControl* access_;
  std::string_view operation_;  // of operations()
  std::string peer_;
  IdentityPtr identity_;
  std::optional<int64_t> link_expires_s_;  // of the link by which it came; empty = by a token
  QuotaPartPtr connection_;
};

}  // namespace viewloom
