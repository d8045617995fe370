// SPDX-License-Identifier: Apache-2.0
// Somebody was granted or refused something.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "access/identity.h"

namespace viewloom {

enum class AuditOutcome : uint8_t { kGranted, kRefused, kChanged };

struct AuditEvent {
  AuditOutcome outcome = AuditOutcome::kGranted;
  std::string_view operation;  // of operations(), or a literal
  std::string peer;
  IdentityPtr identity;  // null = nobody is proven
  std::string stream;
  std::string reason;
  uint64_t count = 0;  // further events like an earlier one; 0 = one event
};

}  // namespace viewloom
