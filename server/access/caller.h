// SPDX-License-Identifier: Apache-2.0
// A client of one call or request, with a proven identity.
#pragma once

#include <string>
#include <string_view>

#include "access/identity.h"
#include "access/operations.h"
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
  // Name of the one whose share of memory and engine time its calls take: the proven identity's
  // id. Where nobody has to prove one, it is the client at `host` (identityOfHost).
  std::string shareName(std::string_view host) const;
  // UNAUTHENTICATED once its identity has expired, was revoked, or has other rights. To be asked
  // now and then while a call lives.
  absl::Status recheck() const;

 private:
  friend class AccessControl;

  Caller(AccessControl& access, std::string_view operation, std::string peer, IdentityPtr identity)
      : access_(&access),
        operation_(operation),
        peer_(std::move(peer)),
        identity_(std::move(identity)) {}

  AccessControl* access_;
  std::string_view operation_;  // of operations()
  std::string peer_;
  IdentityPtr identity_;
};

}  // namespace viewloom
